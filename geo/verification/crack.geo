// A square plate with a straight crack in its middle, inclined to the horizontal. Half the crack is 1 m long.
// Physical groups: plate; crack; base top; pin (the middle of the base); middle (of the crack)
SetFactory("OpenCASCADE");
DefineConstant[
  angle = {45, Min 0, Max 80, Name "Inclination of the crack [degrees]"}
  size  = {20, Min 4, Max 100, Name "Half the side of the plate over half the crack [-]"}
  along = {60, Min 4, Max 400, Step 2, Name "Elements along the crack [-]"}
  order = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
Rectangle(1) = {-size, -size, 0, 2 * size, 2 * size};
Point(10) = {-c, -s, 0}; Point(11) = {0, 0, 0}; Point(12) = {c, s, 0};
Line(20) = {10, 11}; Line(21) = {11, 12};
Point(13) = {0, -size, 0};
BooleanFragments{ Surface{1}; Delete; }{ Curve{20, 21}; Point{13}; Delete; }
e = 1e-6;
crack() = Curve In BoundingBox{-c - e, -s - e, -e, c + e, s + e, e};
base() = Curve In BoundingBox{-size - e, -size - e, -e, size + e, -size + e, e};
top() = Curve In BoundingBox{-size - e, size - e, -e, size + e, size + e, e};
pin() = Point In BoundingBox{-e, -size - e, -e, e, -size + e, e};
middle() = Point In BoundingBox{-e, -e, -e, e, e, e};
Transfinite Curve{crack()} = along / 2 + 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Distance; Field[1].CurvesList = {crack()};
Field[2] = MathEval; Field[2].F = Sprintf("%g + 0.15 * F1", 2 / along);
Background Field = 2;
Physical Surface("plate") = Surface{:};
Physical Curve("crack") = {crack()};
Physical Curve("base") = {base()}; Physical Curve("top") = {top()};
Physical Point("pin") = {pin()}; Physical Point("middle") = {middle()};
Mesh.ElementOrder = order;
