// Two concrete boxes side by side in two layers of ground (plane strain). They touch along a common wall line, in a joint
// of its own, which ends on the joint of the ground at both ends: two triple points.
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the line between the boxes; both stand on one level.
//
// Physical groups:
//   box_left box_right          boxes
//   ground_upper ground_lower   ground
//   between                     left box on right box
//   skin_left skin_right        the rest of their outer faces: each box on the ground
//   surface base side_left side_right   edges of the ground
//   ROOF_LEFT ROOF_RIGHT        middles of the roofs, outer face

SetFactory("OpenCASCADE");

DefineConstant[
  width   = {30,  Min 8,    Max 200, Step 1,   Name "1Ground/1Width [m]"}
  height  = {14,  Min 4,    Max 100, Step 1,   Name "1Ground/2Height [m]"}
  layer   = {6,   Min 0.5,  Max 100, Step 0.5, Name "1Ground/3Depth of the bottom of the upper layer [m]"}
  depth   = {4.5, Min 1,    Max 30,  Step 0.1, Name "2Boxes/1Depth of their undersides [m]"}
  width_left   = {3.5, Min 0.5, Max 15, Step 0.1, Name "2Boxes/2Outer width of the left box [m]"}
  height_left  = {3.0, Min 0.5, Max 15, Step 0.1, Name "2Boxes/3Outer height of the left box [m]"}
  width_right  = {2.5, Min 0.5, Max 15, Step 0.1, Name "2Boxes/4Outer width of the right box [m]"}
  height_right = {2.2, Min 0.5, Max 15, Step 0.1, Name "2Boxes/5Outer height of the right box [m]"}
  wall    = {0.3, Min 0.05, Max 2,   Step 0.05, Name "2Boxes/6Wall thickness [m]"}
  size_near = {0.15, Min 0.02, Max 2, Step 0.05, Name "3Mesh/1Element size at the boxes [m]"}
  size_far  = {1.2, Min 0.05, Max 10, Step 0.1, Name "3Mesh/2Element size far from them [m]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/3Order of the elements [-]"}
  refine  = {1, Min 0.25,   Max 16,  Step 0.5, Name "3Mesh/4All sizes are divided by [-]"}
];

tiny = 1e-4;
b() = {width_left, width_right}; h() = {height_left, height_right};
For k In {0:1}
  If (2 * wall >= b(k) || 2 * wall >= h(k))
    Error("wall = %g m leaves no opening in a box of %g m by %g m.", wall, b(k), h(k)); Abort;
  EndIf
  If (h(k) > depth - size_near)
    Error("A box of %g m comes out of the ground: its underside is at depth = %g m.", h(k), depth); Abort;
  EndIf
EndFor
If (Fabs(height_left - height_right) > 1e-9 && Fabs(height_left - height_right) < size_near)
  Error("height_left = %g m and height_right = %g m: make them equal, or unlike by an element, %g m.", height_left, height_right, size_near); Abort;
EndIf
If (layer < depth + size_near || height < layer + size_near)
  Error("layer = %g m must lie below the boxes, depth = %g m, and above height = %g m.", layer, depth, height); Abort;
EndIf
If (width / 2 < width_left + size_far || width / 2 < width_right + size_far)
  Error("The boxes come out of the ground of width = %g m.", width); Abort;
EndIf

// ---------------------------------------------------------------- ground and boxes

Rectangle(1) = {-width / 2, -layer, 0, width, layer};
Rectangle(2) = {-width / 2, -height, 0, width, height - layer};
For k In {0:1}
  x = k ? 0 : -b(0);
  Rectangle(3 + k) = {x, -depth, 0, b(k), h(k)};
  Rectangle(5 + k) = {x + wall, -depth + wall, 0, b(k) - 2 * wall, h(k) - 2 * wall};
EndFor
BooleanDifference(7) = { Surface{1}; Delete; }{ Surface{3, 4}; };
BooleanDifference(8) = { Surface{3}; Delete; }{ Surface{5}; Delete; };
BooleanDifference(9) = { Surface{4}; Delete; }{ Surface{6}; Delete; };
p = newp; Point(p) = {-b(0) / 2, -depth + h(0), 0}; Point(p + 1) = {b(1) / 2, -depth + h(1), 0};
BooleanFragments{ Surface{2, 7, 8, 9}; Delete; }{ Point{p, p + 1}; Delete; }

// ---------------------------------------------------------------- names, by place

t = tiny; w = width / 2 + t;
left() = Surface In BoundingBox{-b(0) - t, -depth - t, -t, t, -depth + h(0) + t, t};
right() = Surface In BoundingBox{-t, -depth - t, -t, b(1) + t, -depth + h(1) + t, t};
lower() = Surface In BoundingBox{-w, -height - t, -t, w, -layer + t, t};
upper() = Surface{:}; upper() -= left(); upper() -= right(); upper() -= lower();
hole_left() = Curve In BoundingBox{-b(0) + wall - t, -depth + wall - t, -t, -wall + t, -depth + h(0) - wall + t, t};
hole_right() = Curve In BoundingBox{wall - t, -depth + wall - t, -t, b(1) - wall + t, -depth + h(1) - wall + t, t};
of_left() = Abs(CombinedBoundary{ Surface{left()}; }); of_left() -= hole_left();
of_right() = Abs(CombinedBoundary{ Surface{right()}; }); of_right() -= hole_right();
low = h(0) < h(1) ? h(0) : h(1);       // height of the common wall line
between() = Curve In BoundingBox{-t, -depth - t, -t, t, -depth + low + t, t};
of_left() -= between(); of_right() -= between();
Physical Surface("box_left") = left();
Physical Surface("box_right") = right();
Physical Surface("ground_upper") = upper();
Physical Surface("ground_lower") = lower();
Physical Curve("between") = between();
Physical Curve("skin_left") = of_left();
Physical Curve("skin_right") = of_right();
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
x = -b(0) / 2; y = -depth + h(0);
Physical Point("ROOF_LEFT") = Point In BoundingBox{x - t, y - t, -t, x + t, y + t, t};
x = b(1) / 2; y = -depth + h(1);
Physical Point("ROOF_RIGHT") = Point In BoundingBox{x - t, y - t, -t, x + t, y + t, t};

// ---------------------------------------------------------------- mesh

Field[1] = Distance; Field[1].CurvesList = {of_left(), of_right(), between()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = wall; Field[2].DistMax = wall + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
