// A strip of one material, from y = 0 down to y = -height, in equal rows.
// Physical groups: ground, surface, base, sides.

DefineConstant[
  height = {10,   Min 0.1, Name "Height [m]"}
  width  = {1,    Min 0.01, Name "Width [m]"}
  size   = {0.05, Min 0.001, Name "Height of an element [m]"}
];

Point(1) = {0, -height, 0};
Point(2) = {width, -height, 0};
Point(3) = {width, 0, 0};
Point(4) = {0, 0, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{2, 4} = 1 + Round(height / size);
Transfinite Curve{1, 3} = 2;
Transfinite Surface{1};
Recombine Surface{1};

Physical Surface("ground") = {1};
Physical Curve("base") = {1};
Physical Curve("surface") = {3};
Physical Curve("sides") = {2, 4};
