// A pipe in wide ground, upper half: a P wave comes along x from the left, y = 0 is the axis of symmetry.
// Physical groups: ground, pipe, inflow, outflow, side (y = reach), axis, front and back (outer face on the axis).

DefineConstant[
  reach     = {8.7,  Min 1, Name "Ground on all sides, from the pipe's centre [m]"}
  lead      = {8.7,  Min 1, Name "Ground before and behind the pipe, from its centre [m]"}
  outer     = {0.6,  Min 0.1, Name "Outer radius [m]"}
  inner     = {0.4,  Min 0.05, Name "Inner radius [m]"}
  around    = {32,   Min 8, Step 4, Name "Elements round half the pipe [-]"}
  through   = {2,    Min 1, Step 1, Name "Elements through the wall [-]"}
  near      = {0.06, Min 0.005, Name "Element size at the pipe [m]"}
  size      = {0.25, Min 0.01, Name "Element size far away [m]"}
];

Point(1) = {0, 0, 0};
Point(2) = {-lead, 0, 0}; Point(3) = {-outer, 0, 0}; Point(4) = {-inner, 0, 0};
Point(5) = {inner, 0, 0}; Point(6) = {outer, 0, 0};  Point(7) = {lead, 0, 0};
Point(8) = {lead, reach, 0}; Point(9) = {-lead, reach, 0};
Point(10) = {0, outer, 0}; Point(11) = {0, inner, 0};
Line(1) = {2, 3}; Line(2) = {3, 4}; Line(3) = {5, 6}; Line(4) = {6, 7};
Line(5) = {7, 8}; Line(6) = {8, 9}; Line(7) = {9, 2}; Line(8) = {10, 11};
Circle(9) = {3, 1, 10}; Circle(10) = {10, 1, 6}; Circle(11) = {4, 1, 11}; Circle(12) = {11, 1, 5};
Curve Loop(1) = {2, 11, -8, -9};   Plane Surface(1) = {1};
Curve Loop(2) = {8, 12, 3, -10};   Plane Surface(2) = {2};
Curve Loop(3) = {1, 9, 10, 4, 5, 6, 7}; Plane Surface(3) = {3};
Transfinite Curve{9, 10, 11, 12} = 1 + around / 2;
Transfinite Curve{2, 3, 8} = 1 + through;
Transfinite Surface{1, 2};
Recombine Surface{1, 2, 3};

Field[1] = Ball;
Field[1].Radius = outer + 2 * near;
Field[1].VIn = near;
Field[1].VOut = size;
Field[1].Thickness = (size - near) / 0.15;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1;

Physical Surface("pipe") = {1, 2};
Physical Surface("ground") = {3};
Physical Curve("inflow") = {7};
Physical Curve("outflow") = {5};
Physical Curve("side") = {6};
Physical Curve("axis") = {1, 2, 3, 4};
Physical Point("front") = {3};
Physical Point("back") = {6};
