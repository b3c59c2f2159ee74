// A ring that nothing holds. Physical groups: ring (faces), outside, inside (curves).

SetFactory("Built-in");

DefineConstant[
  radius  = {0.95, Min 0.01, Max 100, Step 0.1,  Name "1Mean radius [m]"}
  wall    = {0.1,  Min 0.001, Max 10, Step 0.01, Name "2Wall [m]"}
  around  = {64,   Min 8, Max 2000, Step 4, Name "3Elements around, a multiple of four [-]"}
  through = {2,    Min 1, Max 50,   Step 1, Name "4Elements through the wall [-]"}
  order   = {2, Choices{1 = "Q4", 2 = "Q8"}, Name "5Order of the elements"}
];

centre = newp; Point(centre) = {0, 0, 0};
For i In {0:3}
  a = i * Pi / 2;
  r = radius - wall / 2;
  R = radius + wall / 2;
  inner() += newp; Point(newp) = {r * Cos(a), r * Sin(a), 0};
  outer() += newp; Point(newp) = {R * Cos(a), R * Sin(a), 0};
  spokes() += newl; Line(newl) = {inner(i), outer(i)};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  bore() += newl; Circle(newl) = {inner(i), centre, inner(j)};
  skin() += newl; Circle(newl) = {outer(i), centre, outer(j)};
  loop = newll; Curve Loop(loop) = {spokes(i), skin(i), -spokes(j), -bore(i)};
  faces() += news; Plane Surface(news) = {loop};
EndFor
Transfinite Curve{bore(), skin()} = 1 + around / 4;
Transfinite Curve{spokes()} = 1 + through;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("ring") = faces();
Physical Curve("outside") = skin();
Physical Curve("inside") = bore();
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;
