#pragma once

namespace breccia::dem {

/// Damping ratio xi of a contact dashpot that cannot pull, for which a free collision ends with the
/// given coefficient of restitution (0 < e <= 1). Linear: c = 2 xi sqrt(m* K); Hertz: c = 2 xi
/// sqrt(m* S_n). Found by bisection on the collision's own equation of motion, in dimensionless
/// form.  [-]
double damping_ratio_linear(double restitution);
double damping_ratio_hertz(double restitution);

}  // namespace breccia::dem
