// A square of 1 m in four blocks: "level" parts the lower from the upper ones, "upright" the left from the right ones.
// Without the lower half of "upright" the two curves meet in a T, with it they cross in an X, at the middle of the square.
// Physical groups: below_left below_right above_left above_right; above left (two blocks each, as bodies of the curves);
//                  level upright; bottom top left_side right_side; pin roller (ends of the bottom)
DefineConstant[
  arms    = {4, Choices{3 = "T", 4 = "X"}, Name "Arms of the junction [-]"}
  angle   = {17, Min -180, Max 180, Name "Angle of the level curve [degrees]"}
  lean    = {0.15, Min -0.4, Max 0.4, Name "Shift of the upright curve's top [m]"}
  along   = {4, Min 1, Max 200, Step 1, Name "Elements along half a side [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
For row In {0:2}
  y = -0.5 + row / 2;
  For column In {0:2}
    x = -0.5 + column / 2;
    If (column == 1)
      x = 2 * lean * y;
    EndIf
    Point(1 + 3 * row + column) = {c * x - s * y, s * x + c * y, 0};
  EndFor
EndFor
For row In {0:2}
  For column In {0:1}
    flat() += newl; Line(newl) = {1 + 3 * row + column, 2 + 3 * row + column};
  EndFor
EndFor
For row In {0:1}
  For column In {0:2}
    up() += newl; Line(newl) = {1 + 3 * row + column, 4 + 3 * row + column};
  EndFor
EndFor
For row In {0:1}
  For column In {0:1}
    loop = newll; Curve Loop(loop) = {flat(2 * row + column), up(3 * row + column + 1), -flat(2 * row + 2 + column), -up(3 * row + column)};
    blocks() += news; Plane Surface(news) = {loop};
  EndFor
EndFor
// joint elements of unequal lengths
Transfinite Curve{flat()} = along + 1 Using Progression 1.3;
Transfinite Curve{up()} = along + 1 Using Progression 0.8;
Transfinite Surface{blocks()} Alternated;
If (corners == 4)
  Recombine Surface{blocks()};
EndIf
Physical Surface("below_left") = blocks(0); Physical Surface("below_right") = blocks(1);
Physical Surface("above_left") = blocks(2); Physical Surface("above_right") = blocks(3);
Physical Surface("above") = {blocks(2), blocks(3)}; Physical Surface("left") = {blocks(0), blocks(2)};
Physical Curve("level") = {flat(2), flat(3)};
If (arms == 4)
  Physical Curve("upright") = {up(1), up(4)};
Else
  Physical Curve("upright") = {up(4)};
EndIf
Physical Curve("bottom") = {flat(0), flat(1)}; Physical Curve("top") = {flat(4), flat(5)};
Physical Curve("left_side") = {up(0), up(3)}; Physical Curve("right_side") = {up(2), up(5)};
Physical Point("pin") = {1}; Physical Point("roller") = {3};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
