// The patch of MacNeal and Harder: a plate of 0.24 x 0.12 in five distorted quadrilaterals, or these cut for triangles.
// Physical groups: plate; bottom right top left; pin (0, 0)  roller (0.24, 0)
DefineConstant[
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
Point(1) = {0, 0, 0}; Point(2) = {0.24, 0, 0}; Point(3) = {0.24, 0.12, 0}; Point(4) = {0, 0.12, 0};
Point(5) = {0.04, 0.02, 0}; Point(6) = {0.18, 0.03, 0}; Point(7) = {0.16, 0.08, 0}; Point(8) = {0.08, 0.08, 0};
For i In {1:4}
  j = i % 4 + 1;
  Line(i) = {i, j};         // edges
  Line(4 + i) = {4 + i, 4 + j}; // edges of the inner quadrilateral
  Line(8 + i) = {i, 4 + i}; // spokes
EndFor
For i In {1:4}
  j = i % 4 + 1;
  Curve Loop(i) = {i, 8 + j, -(4 + i), -(8 + i)};
  Plane Surface(i) = {i};
EndFor
Curve Loop(5) = {5, 6, 7, 8}; Plane Surface(5) = {5};
Transfinite Curve{:} = 2;
Transfinite Surface{:};
If (corners == 4)
  Recombine Surface{:};
EndIf
Physical Surface("plate") = {1:5};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("top") = {3}; Physical Curve("left") = {4};
Physical Point("pin") = {1}; Physical Point("roller") = {2};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
