cat > quads.geo <<'END'
// rock of 50 x 100 mm in quadrangles of about 3 mm, in metres
Point(1) = {-0.025, -0.05, 0, 0.003};
Point(2) = {0.025, -0.05, 0, 0.003};
Point(3) = {0.025, 0.05, 0, 0.003};
Point(4) = {-0.025, 0.05, 0, 0.003};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Recombine Surface {1};
Physical Surface("ROCK") = {1};
END
