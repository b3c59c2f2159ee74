// Half of a block of steel on a narrow, nearly rigid strip, symmetric about x = 0. The profile of the cylinder stands in
// the gaps of the joints, one curve an element: joint_1 ... joint_n from the axis.
// Physical groups: block strip; joint_1 ... joint_n; axis (x = 0, block)  axis_strip; top; base (of the strip)
DefineConstant[
  n    = {32, Min 8, Max 200, Step 1, Name "Joints [-]"}
  wide = {2.4e-3, Min 1e-6, Max 1, Name "Half-width of the strip [m]"}
  size = {0.1, Min 1e-3, Max 10, Name "Width and height of the half block [m]"}
];
h = wide / n;
deep = wide / 4;
growth = 1.12;
For i In {0:n}
  Point(1 + i) = {i * h, 0, 0};
  Point(1001 + i) = {i * h, -deep, 0};
  Point(2001 + i) = {i * h, wide, 0};
EndFor
For i In {1:n}
  Line(i) = {i, i + 1}; Line(1000 + i) = {1000 + i, 1001 + i}; Line(2000 + i) = {2000 + i, 2001 + i};
EndFor
Line(3001) = {1001, 1}; Line(3002) = {1001 + n, 1 + n};
Line(3003) = {1, 2001}; Line(3004) = {1 + n, 2001 + n};
Curve Loop(1) = {1001:1000 + n, 3002, -n:-1, -3001}; Plane Surface(1) = {1};
Curve Loop(2) = {1:n, 3004, -(2000 + n):-2001, -3003}; Plane Surface(2) = {2};
Transfinite Curve{1:n, 1001:1000 + n, 2001:2000 + n} = 2;
Transfinite Curve{3001, 3002} = 5; Transfinite Curve{3003, 3004} = n + 1;
Transfinite Surface{1} = {1001, 1001 + n, 1 + n, 1};
Transfinite Surface{2} = {1, 1 + n, 2001 + n, 2001};
Point(4001) = {size, 0, 0}; Point(4002) = {size, size, 0}; Point(4003) = {0, size, 0};
Line(4001) = {1 + n, 4001}; Line(4002) = {4001, 4002}; Line(4003) = {4002, 4003};
Line(4004) = {2001, 4003}; Line(4005) = {2001 + n, 4002};
layers = Ceil(Log(1 + (size - wide) / h * (growth - 1)) / Log(growth));
Transfinite Curve{4001, 4004, 4005} = layers + 1 Using Progression growth;
Transfinite Curve{4002, 4003} = n + 1;
Curve Loop(3) = {4001, 4002, -4005, -3004}; Plane Surface(3) = {3};
Curve Loop(4) = {2001:2000 + n, 4005, 4003, -4004}; Plane Surface(4) = {4};
Transfinite Surface{3} = {1 + n, 4001, 4002, 2001 + n};
Transfinite Surface{4} = {2001, 2001 + n, 4002, 4003};
Recombine Surface{:};
Physical Surface("strip") = {1}; Physical Surface("block") = {2, 3, 4};
For i In {1:n}
  Physical Curve(Sprintf("joint_%g", i)) = {i};
EndFor
Physical Curve("base") = {1001:1000 + n}; Physical Curve("axis_strip") = {3001};
Physical Curve("axis") = {3003, 4004}; Physical Curve("top") = {4003};
