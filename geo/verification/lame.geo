// Quarter of a thick cylinder: inner radius a, outer radius b, symmetric about both axes.
// Physical groups: pipe; inner outer (faces); axis_x axis_y (planes of symmetry); A (b, 0)  B (a, 0)
SetFactory("OpenCASCADE");
DefineConstant[
  a       = {0.4, Min 0.01, Max 100, Name "Inner radius [m]"}
  b       = {0.6, Min 0.02, Max 200, Name "Outer radius [m]"}
  through = {4, Min 1, Max 200, Step 1, Name "Divisions through the wall [-]"}
  around  = {3, Min 1, Max 20, Step 1, Name "Divisions of the quarter for one through the wall [-]"}
  corners = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order   = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0}; Point(3) = {b, 0, 0}; Point(4) = {0, b, 0}; Point(5) = {0, a, 0};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = through + 1;
Transfinite Curve{2, 4} = around * through + 1;
Transfinite Surface{1} = {2, 3, 4, 5} Alternated;
If (corners == 4)
  Recombine Surface{1};
EndIf
Physical Surface("pipe") = {1};
Physical Curve("axis_x") = {1}; Physical Curve("outer") = {2};
Physical Curve("axis_y") = {3}; Physical Curve("inner") = {4};
Physical Point("A") = {3}; Physical Point("B") = {2};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
