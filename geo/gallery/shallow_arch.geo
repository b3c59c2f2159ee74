// A shallow concrete arch whose crown comes out of the ground (plane strain). It stands on both feet in the ground and is
// bonded nowhere: each foot is surrounded by a joint that runs from the ground's surface outside to the floor inside.
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the axis of the arch, a half ring.
//
// Physical groups:
//   arch                        half ring
//   ground_upper ground_lower   ground; the floor inside the arch belongs to the upper layer
//   foot_left foot_right        joints of the feet: outer face, underside, inner face
//   crown                       the part of the outer face in the open air
//   surface base side_left side_right   edges of the ground; the surface ends at the arch
//   CROWN FOOT_LEFT FOOT_RIGHT  top of the arch, middles of the undersides of its feet

SetFactory("OpenCASCADE");

DefineConstant[
  width   = {24,  Min 8,    Max 200, Step 1,   Name "1Ground/1Width [m]"}
  height  = {10,  Min 3,    Max 100, Step 1,   Name "1Ground/2Height [m]"}
  layer   = {4.5, Min 0.5,  Max 100, Step 0.5, Name "1Ground/3Depth of the bottom of the upper layer [m]"}
  radius  = {3.0, Min 0.5,  Max 15,  Step 0.1, Name "2Arch/1Outer radius [m]"}
  lining  = {0.3, Min 0.05, Max 2,   Step 0.05, Name "2Arch/2Thickness [m]"}
  rise    = {0.8, Min 0.05, Max 10,  Step 0.1, Name "2Arch/3Height of the crown above the surface [m]"}
  embed   = {0.6, Min 0.05, Max 5,   Step 0.1, Name "2Arch/4Depth of the feet below the floor [m]"}
  size_near = {0.15, Min 0.02, Max 2, Step 0.05, Name "3Mesh/1Element size at the arch [m]"}
  size_far  = {1.0, Min 0.05, Max 10, Step 0.1, Name "3Mesh/2Element size far from it [m]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/3Order of the elements [-]"}
  refine  = {1, Min 0.25,   Max 16,  Step 0.5, Name "3Mesh/4All sizes are divided by [-]"}
];

axis = rise - radius;                  // level of the feet
floor = axis + embed;
in = radius - lining;
tiny = 1e-4;

If (in <= 0 || embed >= in)
  Error("lining = %g m and embed = %g m leave no opening under an arch of radius = %g m.", lining, embed, radius); Abort;
EndIf
If (rise >= radius - embed)
  Error("rise = %g m lifts the floor at %g m out of the ground.", rise, floor); Abort;
EndIf
If (layer < -axis + size_near || height < layer + size_near)
  Error("layer = %g m must lie below the feet at %g m, and above height = %g m.", layer, -axis, height); Abort;
EndIf
If (width < 2 * radius + 2 * size_far)
  Error("width = %g m is narrower than the arch of radius = %g m.", width, radius); Abort;
EndIf

// ---------------------------------------------------------------- ground and arch

Rectangle(1) = {-width / 2, -layer, 0, width, layer};
Rectangle(2) = {-width / 2, -height, 0, width, height - layer};
Disk(3) = {0, axis, 0, radius};
Disk(4) = {0, axis, 0, in};
Rectangle(5) = {-radius, axis - radius, 0, 2 * radius, radius}; // below the feet
BooleanDifference(6) = { Surface{3}; Delete; }{ Surface{4, 5}; };          // the arch
BooleanDifference(7) = { Surface{4}; Delete; }{ Surface{5}; Delete; };     // all under it
Rectangle(8) = {-radius, axis, 0, 2 * radius, embed};
BooleanDifference(9) = { Surface{7}; Delete; }{ Surface{8}; Delete; };     // the room above the floor
BooleanDifference(10) = { Surface{1}; Delete; }{ Surface{6, 9}; };
Recursive Delete { Surface{9}; }
p = newp;
Point(p) = {0, axis + radius, 0};
Point(p + 1) = {-radius + lining / 2, axis, 0}; Point(p + 2) = {radius - lining / 2, axis, 0};
BooleanFragments{ Surface{2, 6, 10}; Delete; }{ Point{p : p + 2}; Delete; }

// ---------------------------------------------------------------- names, by place

t = tiny; w = width / 2 + t; x = radius + t;
ring() = Surface In BoundingBox{-x, axis - t, -t, x, axis + x, t};
ground() = Surface{:}; ground() -= ring();
lower() = Surface In BoundingBox{-w, -height - t, -t, w, -layer + t, t};
ground() -= lower();
// the floor's ground has the arch on both its sides, and may be found among what lies inside the ring's box
under() = Surface In BoundingBox{-in - t, axis - t, -t, in + t, floor + t, t};
ring() -= under(); ground() -= under(); ground() += under();
face() = Abs(CombinedBoundary{ Surface{ring()}; });
of_ground() = Abs(CombinedBoundary{ Surface{ground()}; });
shared() = face(); air() = face(); air() -= of_ground(); shared() -= air();
foot_left() = {}; foot_right() = {};
For i In {0:#shared() - 1}
  box() = BoundingBox Curve{shared(i)};
  If (box(3) < t)
    foot_left() += shared(i);
  Else
    foot_right() += shared(i);
  EndIf
EndFor
crown() = air(); crown() -= Curve In BoundingBox{-in - t, floor - t, -t, in + t, axis + in + t, t};
Physical Surface("arch") = ring();
Physical Surface("ground_upper") = ground();
Physical Surface("ground_lower") = lower();
Physical Curve("foot_left") = foot_left();
Physical Curve("foot_right") = foot_right();
Physical Curve("crown") = crown();
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
Physical Point("CROWN") = Point In BoundingBox{-t, axis + radius - t, -t, t, axis + radius + t, t};
x = -radius + lining / 2;
Physical Point("FOOT_LEFT") = Point In BoundingBox{x - t, axis - t, -t, x + t, axis + t, t};
Physical Point("FOOT_RIGHT") = Point In BoundingBox{-x - t, axis - t, -t, -x + t, axis + t, t};

// ---------------------------------------------------------------- mesh

Field[1] = Distance; Field[1].CurvesList = {face()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = lining; Field[2].DistMax = lining + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
