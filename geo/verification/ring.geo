// A ring in a square of ground so wide that its edges are far away, about (0, 0).
// Physical groups: ring soil; interface (outer face of the ring); top bottom left right;
//                  axis_x axis_y (the lines y = 0 and x = 0, in ring and ground)
DefineConstant[
  inner   = {0.9, Min 0.01, Max 100, Name "Inner radius [m]"}
  outer   = {1.0, Min 0.02, Max 100, Name "Outer radius [m]"}
  far     = {40, Min 2, Max 1000, Name "Half the width of the ground over the outer radius [-]"}
  octant  = {12, Min 2, Max 200, Step 1, Name "Elements round an eighth of the ring [-]"}
  through = {4, Min 1, Max 50, Step 1, Name "Elements through the wall [-]"}
  stretch = {1, Min 0.5, Max 4, Name "Length of the ground's elements over their width [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
half = far * outer;
growth = 1 + stretch * Pi / 4 / octant; // elements keep their shape
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
If (corners == 4)
  Recombine Surface{sectors(), ground()};
EndIf
Physical Surface("ring") = sectors();
Physical Surface("soil") = ground();
Physical Curve("interface") = face();
Physical Curve("right") = {edge(7), edge(0)}; Physical Curve("top") = {edge(1), edge(2)};
Physical Curve("left") = {edge(3), edge(4)}; Physical Curve("bottom") = {edge(5), edge(6)};
Physical Curve("axis_x") = {wall(0), ray(0), wall(4), ray(4)};
Physical Curve("axis_y") = {wall(2), ray(2), wall(6), ray(6)};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
