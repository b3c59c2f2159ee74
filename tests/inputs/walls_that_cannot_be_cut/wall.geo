// A round or square wall by itself, four ways that rays from its centre do not cut into sections:
// kind 1 unstructured triangles, 2 paved quadrangles, 3 a square box, 4 a bore 5 cm off the centre.
//   gmsh -2 wall.geo -setnumber kind 1 -o unstructured_triangles.msh
DefineConstant[ kind = 1 ];
outer = kind == 3 ? Sqrt(2) : 1; inner = 0.8 * outer; first = kind == 3 ? Pi/4 : 0; up = kind == 4 ? 0.05 : 0;
Point(1) = {0, -3, 0}; Point(2) = {0, -3 + up, 0};
For i In {0:3}
  Point(10+i) = {outer*Cos(first + i*Pi/2), -3 + outer*Sin(first + i*Pi/2), 0};
  Point(20+i) = {inner*Cos(first + i*Pi/2), -3 + up + inner*Sin(first + i*Pi/2), 0};
  Line(30+i) = {20+i, 10+i};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  If (kind == 3)
    Line(40+i) = {10+i, 10+j}; Line(50+i) = {20+i, 20+j};
  Else
    Circle(40+i) = {10+i, 1, 10+j}; Circle(50+i) = {20+i, 2, 20+j};
  EndIf
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Curve Loop(60+i) = {30+i, 40+i, -(30+j), -(50+i)}; Plane Surface(70+i) = {60+i};
EndFor
Transfinite Curve{40:43, 50:53} = 9; Transfinite Curve{30:33} = 3;
If (kind > 2)
  Transfinite Surface{70:73};
EndIf
If (kind > 1)
  Recombine Surface{70:73};
EndIf
Physical Surface("wall") = {70:73};
Physical Curve("face") = {40:43};
