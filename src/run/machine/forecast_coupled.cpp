#include "run/machine/forecast_parts.hpp"

namespace breccia {

Forecast forecast(const coupled::Config& config, const std::string& folder,
                  const ModelStep& model) {
  const coupled::Parts parts = coupled::parts_of(config);
  const Forecast a = forecast(parts.spheres, folder, model),
                 b = forecast(parts.tetrahedra, folder, model);
  Forecast f;
  f.item_name = "spheres and tetrahedra";
  f.bond_name = "links and joints";
  if (a.items == 0.0 || b.items == 0.0) return f;
  f.items = a.items + b.items;
  f.bonds = a.bonds + b.bonds;
  take_step(f, a.step, a.step_rule);
  take_step(f, b.step, b.step_rule);
  take_size(f, a.least, a.least_name);
  take_size(f, b.least, b.least_name);
  f.cut_by_lines = b.cut_by_lines;
  finish(f, config.time, config.time.end, model);
  // Both take the steps of the one that needs more.
  for (const Forecast* part : {&a, &b}) {
    if (part->steps > 0.0) f.here_s += part->here_s * (f.steps / part->steps);
    f.output_s += part->output_s;
    f.setup_s += part->setup_s;
    f.memory += part->memory;
    f.disk += part->disk;
  }
  f.memory -= own_memory;  // the program's own, once, and one picture
  if (draws(config.output)) f.memory -= pixel_of_spheres * pixels_of(config.output);
  f.longest_part = (a.disk > b.disk ? a : b).longest_part;
  return f;
}

}  // namespace breccia
