// A concrete box culvert with rounded corners in a backfilled trench, in two layers of ground (plane strain).
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the axis of the box.
//
// Physical groups:
//   culvert                     concrete box
//   backfill                    trench, 0.3 m of bedding below the box included
//   ground_upper ground_lower   natural ground
//   skin                        outer face of the box: a closed curve
//   surface base side_left side_right   edges of the ground (the surface includes that of the backfill)
//   ROOF FLOOR WALL             middles of roof, floor and left wall, outer face

SetFactory("OpenCASCADE");

DefineConstant[
  width     = {24,  Min 8,    Max 200, Step 1,   Name "1Ground/1Width [m]"}
  height    = {12,  Min 4,    Max 100, Step 1,   Name "1Ground/2Height [m]"}
  layer     = {6,   Min 0.5,  Max 100, Step 0.5, Name "1Ground/3Depth of the bottom of the upper layer [m]"}
  cover     = {1.5, Min 0.2,  Max 20,  Step 0.1, Name "2Culvert/1Cover over the roof [m]"}
  box_width = {3.0, Min 0.5,  Max 15,  Step 0.1, Name "2Culvert/2Outer width [m]"}
  box_height = {2.4, Min 0.5, Max 15,  Step 0.1, Name "2Culvert/3Outer height [m]"}
  wall      = {0.3, Min 0.05, Max 2,   Step 0.05, Name "2Culvert/4Wall thickness [m]"}
  corner    = {0.4, Min 0.05, Max 3,   Step 0.05, Name "2Culvert/5Radius of the outer corners [m]"}
  fillet    = {0.15, Min 0.05, Max 3,  Step 0.05, Name "2Culvert/6Radius of the inner corners [m]"}
  bottom    = {4.2, Min 0.5,  Max 30,  Step 0.1, Name "3Trench/1Width at its bottom [m]"}
  slope     = {45,  Min 20,   Max 85,  Step 5,   Name "3Trench/2Slope of its sides [degrees]"}
  size_near = {0.15, Min 0.02, Max 2,  Step 0.05, Name "4Mesh/1Element size at the box [m]"}
  size_far  = {1.0, Min 0.05, Max 10,  Step 0.1, Name "4Mesh/2Element size far from it [m]"}
  order     = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "4Mesh/3Order of the elements [-]"}
  refine    = {1, Min 0.25,   Max 16,  Step 0.5, Name "4Mesh/4All sizes are divided by [-]"}
];

bedding = 0.3;                         // under the box [m]
roof = -cover; floor = roof - box_height; deep = floor - bedding;
top_width = bottom - 2 * deep / Tan(slope * Pi / 180); // of the trench, at the surface
tiny = 1e-4;                           // half-width of the boxes that find things by place

If (layer < -deep + size_near || height < layer + size_near)
  Error("layer = %g m must lie below the trench, %g m deep, and above height = %g m.", layer, -deep, height); Abort;
EndIf
If (top_width > width - 2 * size_far)
  Error("The trench is %g m wide at the surface: widen the ground, width = %g m, or steepen slope = %g degrees.", top_width, width, slope); Abort;
EndIf
If (bottom < box_width + 0.2)
  Error("bottom = %g m leaves no backfill beside the box of box_width = %g m.", bottom, box_width); Abort;
EndIf
If (2 * wall + 2 * fillet > box_width || 2 * wall + 2 * fillet > box_height || 2 * corner > box_width || 2 * corner > box_height)
  Error("wall = %g m, corner = %g m and fillet = %g m do not fit into the box of %g m by %g m.", wall, corner, fillet, box_width, box_height); Abort;
EndIf
If (corner > fillet + 3 * wall)
  Error("corner = %g m cuts the corner of the box open: at most fillet + 3 wall = %g m.", corner, fillet + 3 * wall); Abort;
EndIf

// ---------------------------------------------------------------- ground, trench and box

Rectangle(1) = {-width / 2, -layer, 0, width, layer};
Rectangle(2) = {-width / 2, -height, 0, width, height - layer};
p = newp;
Point(p) = {-bottom / 2, deep, 0};  Point(p + 1) = {bottom / 2, deep, 0};
Point(p + 2) = {top_width / 2, 0, 0}; Point(p + 3) = {-top_width / 2, 0, 0};
l = newl;
For i In {0:3}
  Line(l + i) = {p + i, p + (i + 1) % 4};
EndFor
loop = newll; Curve Loop(loop) = {l, l + 1, l + 2, l + 3};
Plane Surface(3) = {loop};
Rectangle(4) = {-box_width / 2, floor, 0, box_width, box_height, corner};
Rectangle(5) = {-box_width / 2 + wall, floor + wall, 0, box_width - 2 * wall, box_height - 2 * wall, fillet};
BooleanDifference(6) = { Surface{4}; }{ Surface{5}; Delete; };
BooleanDifference(7) = { Surface{3}; }{ Surface{4}; };
BooleanDifference(8) = { Surface{1}; Delete; }{ Surface{3}; Delete; };
Recursive Delete { Surface{4}; }
probe = newp;
Point(probe) = {0, roof, 0}; Point(probe + 1) = {0, floor, 0}; Point(probe + 2) = {-box_width / 2, (roof + floor) / 2, 0};
BooleanFragments{ Surface{2, 6, 7, 8}; Delete; }{ Point{probe : probe + 2}; Delete; }

// ---------------------------------------------------------------- names, by place

x = box_width / 2 + tiny; w = width / 2 + tiny; t = tiny;
box() = Surface In BoundingBox{-x, floor - t, -t, x, roof + t, t};
trench() = Surface In BoundingBox{-top_width / 2 - t, deep - t, -t, top_width / 2 + t, t, t}; trench() -= box();
lower() = Surface In BoundingBox{-w, -height - t, -t, w, -layer + t, t};
upper() = Surface{:}; upper() -= box(); upper() -= trench(); upper() -= lower();
skin() = Abs(CombinedBoundary{ Surface{box()}; });
skin() -= Curve In BoundingBox{-x + wall, floor + wall - t, -t, x - wall, roof - wall + t, t};
Physical Surface("culvert") = box();
Physical Surface("backfill") = trench();
Physical Surface("ground_upper") = upper();
Physical Surface("ground_lower") = lower();
Physical Curve("skin") = skin();
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
Physical Point("ROOF") = Point In BoundingBox{-t, roof - t, -t, t, roof + t, t};
Physical Point("FLOOR") = Point In BoundingBox{-t, floor - t, -t, t, floor + t, t};
Physical Point("WALL") = Point In BoundingBox{-x, (roof + floor) / 2 - t, -t, -box_width / 2 + t, (roof + floor) / 2 + t, t};

// ---------------------------------------------------------------- mesh

Field[1] = Distance; Field[1].CurvesList = {skin()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = wall; Field[2].DistMax = wall + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
