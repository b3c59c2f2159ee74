// A square of 1 m with a straight joint through its middle, turned by `angle`. The joint's elements have unequal lengths.
// Physical groups: below above; joint; bottom top left right; pin roller (ends of the bottom)
DefineConstant[
  angle   = {17, Min -180, Max 180, Name "Angle of the joint [degrees]"}
  along   = {5, Min 1, Max 200, Step 1, Name "Elements along the joint [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
For row In {0:2}
  y = -0.5 + row / 2;
  For column In {0:1}
    Point(1 + 2 * row + column) = {column * c - y * s, column * s + y * c, 0};
  EndFor
EndFor
Line(1) = {1, 2}; Line(2) = {3, 4}; Line(3) = {5, 6};
Line(4) = {1, 3}; Line(5) = {3, 5}; Line(6) = {2, 4}; Line(7) = {4, 6};
Curve Loop(1) = {1, 6, -2, -4}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 7, -3, -5}; Plane Surface(2) = {2};
Transfinite Curve{1} = along + 1;
Transfinite Curve{2} = along + 1 Using Progression 1.4;
Transfinite Curve{3} = along + 1 Using Progression 0.8;
Transfinite Curve{4, 5, 6, 7} = Ceil(along / 2) + 1;
Transfinite Surface{1, 2};
If (corners == 4)
  Recombine Surface{1, 2};
EndIf
Physical Surface("below") = {1}; Physical Surface("above") = {2};
Physical Curve("bottom") = {1}; Physical Curve("joint") = {2}; Physical Curve("top") = {3};
Physical Curve("left") = {4, 5}; Physical Curve("right") = {6, 7};
Physical Point("pin") = {1}; Physical Point("roller") = {2};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
