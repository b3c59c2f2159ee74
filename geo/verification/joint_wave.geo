// A bar along x with one straight joint in its middle: left, right, joint, ends and sides.

DefineConstant[
  half  = {2,    Min 0.1,   Name "Length on either side of the joint [m]"}
  size  = {0.03, Min 0.001, Name "Length of an element [m]"}
  width = {0.1,  Min 0.001, Name "Width [m]"}
];

For i In {0:2}
  below() += newp; Point(newp) = {(i - 1) * half, 0, 0};
  above() += newp; Point(newp) = {(i - 1) * half, width, 0};
  cross() += newl; Line(newl) = {below(i), above(i)};
EndFor
For i In {0:1}
  a = newl; Line(a) = {below(i), below(i + 1)};
  b = newl; Line(b) = {above(i), above(i + 1)};
  along() += {a, b};
  loop = newll; Curve Loop(loop) = {a, cross(i + 1), -b, -cross(i)};
  faces() += news; Plane Surface(news) = {loop};
EndFor
Transfinite Curve{along()} = 1 + Round(half / size);
Transfinite Curve{cross()} = 2;
Transfinite Surface{faces()};
Recombine Surface{faces()};

Physical Surface("left") = {faces(0)};
Physical Surface("right") = {faces(1)};
Physical Curve("end_left") = {cross(0)};
Physical Curve("joint") = {cross(1)};
Physical Curve("end_right") = {cross(2)};
Physical Curve("sides") = {along()};
