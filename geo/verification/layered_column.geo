// A strip of the paper's three layers, or wider ground without pipes: rectangles in equal rows.
// y = 0 is the surface. Physical groups: layer_1 layer_2 layer_3, surface, base, sides.

DefineConstant[
  layer_1_depth = {3,   Min 0.1, Name "Depth of the bottom of layer 1 [m]"}
  layer_2_depth = {7,   Min 0.2, Name "Depth of the bottom of layer 2 [m]"}
  height        = {15,  Min 0.3, Name "Depth of the base [m]"}
  width         = {1,   Min 0.01, Name "Width [m]"}
  across        = {1,   Min 1, Step 1, Name "Elements across [-]"}
  size          = {0.1, Min 0.001, Name "Height of an element [m]"}
];

level() = {0, -layer_1_depth, -layer_2_depth, -height};
For i In {0:3}
  left() += newp;  Point(newp) = {0, level(i), 0};
  right() += newp; Point(newp) = {width, level(i), 0};
  rows() += newl;  Line(newl) = {left(i), right(i)};
EndFor
For i In {1:3}
  l = newl; Line(l) = {left(i), left(i - 1)};
  r = newl; Line(r) = {right(i), right(i - 1)};
  sides() += {l, r};
  Transfinite Curve{l, r} = 1 + Round((level(i - 1) - level(i)) / size);
  loop = newll; Curve Loop(loop) = {rows(i), r, -rows(i - 1), -l};
  face = news; Plane Surface(face) = {loop};
  faces() += face;
  Physical Surface(Sprintf("layer_%g", i)) = {face};
EndFor
Transfinite Curve{rows()} = 1 + across;
Transfinite Surface{faces()};
Recombine Surface{faces()};

Physical Curve("surface") = {rows(0)};
Physical Curve("base") = {rows(3)};
Physical Curve("sides") = {sides()};
