// Cook's membrane: (0,0) (48,44) (48,60) (0,44), n x n elements.
// Physical groups: membrane; root end bottom top; C (48, 52)  D (48, 60)
DefineConstant[
  n       = {16, Min 2, Max 256, Step 2, Name "Elements on a side [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
Point(1) = {0, 0, 0}; Point(2) = {48, 44, 0}; Point(3) = {48, 52, 0}; Point(4) = {48, 60, 0}; Point(5) = {0, 44, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Curve Loop(1) = {1:5}; Plane Surface(1) = {1};
Transfinite Curve{1, 4, 5} = n + 1;
Transfinite Curve{2, 3} = n / 2 + 1;
Transfinite Surface{1} = {1, 2, 4, 5};
If (corners == 4)
  Recombine Surface{1};
EndIf
Physical Surface("membrane") = {1};
Physical Curve("bottom") = {1}; Physical Curve("end") = {2, 3}; Physical Curve("top") = {4}; Physical Curve("root") = {5};
Physical Point("C") = {3}; Physical Point("D") = {4};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
