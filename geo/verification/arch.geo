// A pipe, or a solid disc, in a square of ground so wide that its edges are far away, about (0, 0).
// The joint runs along the pipe's upper half only and ends in the solid at both springlines; below, pipe and ground are one.
// Physical groups: pipe soil; core (fills the bore of a solid disc); arch (upper half of the pipe's outer face);
//                  top bottom left right; axis_y (the line x = 0 in the ground); pin (middle of the bottom)
DefineConstant[
  inner   = {0.8, Min 0.01, Max 100, Name "Inner radius [m]"}
  outer   = {1.0, Min 0.02, Max 100, Name "Outer radius [m]"}
  solid   = {0, Choices{0 = "open", 1 = "filled"}, Name "Bore"}
  far     = {40, Min 2, Max 1000, Name "Half the width of the ground over the outer radius [-]"}
  octant  = {16, Min 2, Max 200, Step 1, Name "Elements round an eighth of the pipe [-]"}
  through = {3, Min 1, Max 50, Step 1, Name "Elements through the wall [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
half = far * outer;
growth = 1 + Pi / 4 / octant; // elements keep their shape
layers = Ceil(Log(far) / Log(growth)); // of elements in the ground
centre = newp; Point(centre) = {0, 0, 0};
x() = {1, 1, 0, -1, -1, -1, 0, 1};     // where the rays at 0, 45, ... degrees meet the square
y() = {0, 1, 1, 1, 0, -1, -1, -1};
For i In {0:7}
  c = Cos(i * Pi / 4); s = Sin(i * Pi / 4);
  a() += newp; Point(newp) = {inner * c, inner * s, 0};
  b() += newp; Point(newp) = {outer * c, outer * s, 0};
  e() += newp; Point(newp) = {half * x(i), half * y(i), 0};
EndFor
For i In {0:7}
  j = (i + 1) % 8;
  bore() += newl; Circle(newl) = {a(i), centre, a(j)};
  face() += newl; Circle(newl) = {b(i), centre, b(j)};
  edge() += newl; Line(newl) = {e(i), e(j)};
  wall() += newl; Line(newl) = {a(i), b(i)};
  ray() += newl; Line(newl) = {b(i), e(i)};
EndFor
For i In {0:7}
  j = (i + 1) % 8;
  loop = newll; Curve Loop(loop) = {wall(i), face(i), -wall(j), -bore(i)};
  sectors() += news; Plane Surface(news) = {loop};
  loop = newll; Curve Loop(loop) = {ray(i), edge(i), -ray(j), -face(i)};
  ground() += news; Plane Surface(news) = {loop};
EndFor
Transfinite Curve{bore(), face(), edge()} = octant + 1;
Transfinite Curve{wall()} = through + 1;
Transfinite Curve{ray()} = layers + 1 Using Progression growth;
Transfinite Surface{sectors(), ground()} Alternated;
If (solid)
  loop = newll; Curve Loop(loop) = {bore()};
  core() += news; Plane Surface(news) = {loop};
  Physical Surface("core") = core();
EndIf
If (corners == 4)
  Recombine Surface{:};
EndIf
Physical Surface("pipe") = sectors();
Physical Surface("soil") = ground();
Physical Curve("arch") = {face(0), face(1), face(2), face(3)};
Physical Curve("right") = {edge(7), edge(0)}; Physical Curve("top") = {edge(1), edge(2)};
Physical Curve("left") = {edge(3), edge(4)}; Physical Curve("bottom") = {edge(5), edge(6)};
Physical Curve("axis_y") = {ray(2), ray(6)};
Physical Point("pin") = e(6);
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
