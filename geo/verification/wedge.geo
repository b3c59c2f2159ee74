// A key block pressed between two side blocks that slide apart on a floor, each against a soft buffer.
//
// Frame: metres; y = 0 is the floor, x = 0 the line where the side blocks meet. The planes of the key lean outwards by
// lean_left and lean_right from the vertical and end in its tip (0, tip). Three joints meet in the tip, three at (0, 0).
// Physical groups: key left right floor buffer_left buffer_right; plane_left plane_right (key on side blocks);
//                  split (left on right block); floor_left floor_right; top (of the key); held (bottom of the floor);
//                  roller_left roller_right (outer ends of the buffers); KEY LEFT RIGHT (points)
DefineConstant[
  lean_left  = {20,  Min 5, Max 60, Name "Lean of the left plane [degrees]"}
  lean_right = {30,  Min 5, Max 60, Name "Lean of the right plane [degrees]"}
  tip        = {0.4, Min 0.05, Max 0.9, Name "Height of the key's tip [m]"}
  half       = {1.5, Min 1, Max 10, Name "Width of a side block at its foot [m]"}
  size       = {0.1, Min 0.01, Max 1, Name "Size of the elements [m]"}
  corners    = {4, Choices{3 = "triangles", 4 = "quadrilaterals"}, Name "Corners of an element [-]"}
  order      = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "Order of the elements [-]"}
];
height = 1; clear = 0.25; buffer = 0.5; deep = 0.3; // of the side blocks, below the buffers; of the buffers; of the floor [m]
xl = -(height - tip) * Tan(lean_left * Pi / 180);
xr = (height - tip) * Tan(lean_right * Pi / 180);
Point(1) = {0, 0, 0}; Point(2) = {0, tip, 0}; Point(3) = {xl, height, 0}; Point(4) = {xr, height, 0};
Point(5) = {-half, 0, 0}; Point(6) = {-half, clear, 0}; Point(7) = {-half, height, 0};
Point(8) = {half, 0, 0}; Point(9) = {half, clear, 0}; Point(10) = {half, height, 0};
Point(11) = {-half - buffer, clear, 0}; Point(12) = {-half - buffer, height, 0};
Point(13) = {half + buffer, clear, 0}; Point(14) = {half + buffer, height, 0};
Point(15) = {-half, -deep, 0}; Point(16) = {half, -deep, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {2, 4}; Line(4) = {3, 4};
Line(5) = {5, 1}; Line(6) = {1, 8};
Line(7) = {5, 6}; Line(8) = {6, 7}; Line(9) = {7, 3};
Line(10) = {8, 9}; Line(11) = {9, 10}; Line(12) = {10, 4};
Line(13) = {6, 11}; Line(14) = {11, 12}; Line(15) = {12, 7};
Line(16) = {9, 13}; Line(17) = {13, 14}; Line(18) = {14, 10};
Line(19) = {5, 15}; Line(20) = {15, 16}; Line(21) = {16, 8};
Curve Loop(1) = {3, -4, -2}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 1, 2, -9, -8, -7}; Plane Surface(2) = {2};
Curve Loop(3) = {6, 10, 11, 12, -3, -1}; Plane Surface(3) = {3};
Curve Loop(4) = {13, 14, 15, -8}; Plane Surface(4) = {4};
Curve Loop(5) = {16, 17, 18, -11}; Plane Surface(5) = {5};
Curve Loop(6) = {19, 20, 21, -6, -5}; Plane Surface(6) = {6};
MeshSize{:} = size;
If (corners == 4)
  Recombine Surface{:};
EndIf
Physical Surface("key") = {1}; Physical Surface("left") = {2}; Physical Surface("right") = {3};
Physical Surface("buffer_left") = {4}; Physical Surface("buffer_right") = {5}; Physical Surface("floor") = {6};
Physical Curve("plane_left") = {2}; Physical Curve("plane_right") = {3}; Physical Curve("split") = {1};
Physical Curve("floor_left") = {5}; Physical Curve("floor_right") = {6};
Physical Curve("top") = {4}; Physical Curve("held") = {20};
Physical Curve("roller_left") = {14}; Physical Curve("roller_right") = {17};
Physical Point("KEY") = {3}; Physical Point("LEFT") = {6}; Physical Point("RIGHT") = {9};
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
