// A strip footing on three layers of ground (plane strain). Ground and footing meet in a joint along both its sides and its
// underside; it can slip, tilt and lift off.
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the axis of the footing.
//
// Physical groups:
//   footing                     concrete
//   layer_1 layer_2 layer_3     ground, from the top
//   seat                        joint of the footing: sides and underside
//   top                         upper face of the footing
//   surface base side_left side_right   edges of the ground; the surface ends at the footing
//   MIDDLE LEFT RIGHT           underside of the footing: its middle and corners

SetFactory("OpenCASCADE");

DefineConstant[
  width   = {20,  Min 4,    Max 200, Step 1,   Name "1Ground/1Width [m]"}
  height  = {10,  Min 2,    Max 100, Step 1,   Name "1Ground/2Height [m]"}
  layer_1_depth = {2, Min 0.2, Max 50, Step 0.5, Name "1Ground/3Depth of the bottom of layer 1 [m]"}
  layer_2_depth = {5, Min 0.3, Max 90, Step 0.5, Name "1Ground/4Depth of the bottom of layer 2 [m]"}
  breadth = {2.0, Min 0.2,  Max 20,  Step 0.1, Name "2Footing/1Breadth [m]"}
  embed   = {0.8, Min 0.05, Max 10,  Step 0.1, Name "2Footing/2Depth of its underside [m]"}
  above   = {0.2, Min 0.01, Max 5,   Step 0.1, Name "2Footing/3Height above the surface [m]"}
  size_near = {0.15, Min 0.02, Max 2, Step 0.05, Name "3Mesh/1Element size at the footing [m]"}
  size_far  = {1.0, Min 0.05, Max 10, Step 0.1, Name "3Mesh/2Element size far from it [m]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/3Order of the elements [-]"}
  refine  = {1, Min 0.25,   Max 16,  Step 0.5, Name "3Mesh/4All sizes are divided by [-]"}
];

half = breadth / 2;
tiny = 1e-4;
level() = {0, -layer_1_depth, -layer_2_depth, -height};

If (layer_2_depth < layer_1_depth + size_near || height < layer_2_depth + size_near)
  Error("The layers end at layer_1_depth = %g m, layer_2_depth = %g m and height = %g m: each must lie deeper than the one before.", layer_1_depth, layer_2_depth, height); Abort;
EndIf
For i In {1:2}
  If (Fabs(level(i) + embed) > 1e-9 && Fabs(level(i) + embed) < size_near)
    Error("layer_%g_depth = %g m passes too close to the underside of the footing at embed = %g m: put it there exactly, or an element away.", i, -level(i), embed); Abort;
  EndIf
EndFor
If (embed > height - size_near || width < breadth + 2 * size_far)
  Error("The footing, %g m by %g m, comes out of the ground of %g m by %g m.", breadth, embed, width, height); Abort;
EndIf

// ---------------------------------------------------------------- ground and footing

For i In {1:3}
  Rectangle(i) = {-width / 2, level(i), 0, width, level(i - 1) - level(i)};
EndFor
Rectangle(4) = {-half, -embed, 0, breadth, embed + above};
layers() = BooleanDifference{ Surface{1:3}; Delete; }{ Surface{4}; };
p = newp; Point(p) = {0, -embed, 0}; Point(p + 1) = {-half, 0, 0}; Point(p + 2) = {half, 0, 0};
BooleanFragments{ Surface{layers(), 4}; Delete; }{ Point{p : p + 2}; Delete; }

// ---------------------------------------------------------------- names, by place

t = tiny; w = width / 2 + t;
footing() = Surface In BoundingBox{-half - t, -embed - t, -t, half + t, above + t, t};
Physical Surface("footing") = footing();
For i In {1:3}
  layer() = Surface In BoundingBox{-w, level(i) - t, -t, w, level(i - 1) + t, t};
  layer() -= footing();
  Physical Surface(Sprintf("layer_%g", i)) = layer();
EndFor
seat() = Curve In BoundingBox{-half - t, -embed - t, -t, half + t, t, t};
Physical Curve("seat") = seat();
Physical Curve("top") = Curve In BoundingBox{-half - t, above - t, -t, half + t, above + t, t};
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
Physical Point("MIDDLE") = Point In BoundingBox{-t, -embed - t, -t, t, -embed + t, t};
Physical Point("LEFT") = Point In BoundingBox{-half - t, -embed - t, -t, -half + t, -embed + t, t};
Physical Point("RIGHT") = Point In BoundingBox{half - t, -embed - t, -t, half + t, -embed + t, t};

// ---------------------------------------------------------------- mesh

Field[1] = Distance; Field[1].CurvesList = {seat()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = size_near; Field[2].DistMax = size_near + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
