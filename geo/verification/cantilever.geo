// A beam, held where the case says. Physical groups: beam, root (x = 0), end (x = length), tip (point in the middle of the end).

SetFactory("Built-in");

DefineConstant[
  length = {10,  Min 0.1,  Max 1000, Step 1,   Name "1Length [m]"}
  depth  = {0.5, Min 0.01, Max 100,  Step 0.1, Name "2Depth [m]"}
  along  = {40,  Min 1, Max 10000, Step 1, Name "3Elements along [-]"}
  across = {2,   Min 2, Max 100,   Step 2, Name "4Elements through the depth, an even number [-]"}
  order  = {2, Choices{1 = "Q4", 2 = "Q8"}, Name "5Order of the elements"}
];

For r In {0:2}
  p() += newp; Point(newp) = {0, (r - 1) * depth / 2, 0};
  q() += newp; Point(newp) = {length, (r - 1) * depth / 2, 0};
  rows() += newl; Line(newl) = {p(r), q(r)};
EndFor
For r In {0:1}
  left() += newl; Line(newl) = {p(r), p(r + 1)};
  right() += newl; Line(newl) = {q(r), q(r + 1)};
  loop = newll; Curve Loop(loop) = {rows(r), right(r), -rows(r + 1), -left(r)};
  faces() += news; Plane Surface(news) = {loop};
EndFor
Transfinite Curve{rows()} = 1 + along;
Transfinite Curve{left(), right()} = 1 + across / 2;
Transfinite Surface{:};
Recombine Surface{:};
Physical Surface("beam") = faces();
Physical Curve("root") = left();
Physical Curve("end") = right();
Physical Point("tip") = q(1);
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1;
