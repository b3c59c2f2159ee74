// A steel pipe encased in a concrete block, in two layers of ground (plane strain): two joints, one inside the other.
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the axis of the pipe.
//
// Physical groups:
//   pipe encasement             steel pipe, concrete block round it
//   ground_upper ground_lower   ground
//   pipe_face                   pipe on encasement: a circle
//   block_face                  encasement on ground: a square
//   surface base side_left side_right   edges of the ground
//   CROWN INVERT                of the pipe, outer face
//   BLOCK                       middle of the top of the block

SetFactory("OpenCASCADE");

DefineConstant[
  width   = {20,  Min 5,    Max 200, Step 1,   Name "1Ground/1Width [m]"}
  height  = {12,  Min 3,    Max 100, Step 1,   Name "1Ground/2Height [m]"}
  layer   = {5,   Min 0.5,  Max 100, Step 0.5, Name "1Ground/3Depth of the bottom of the upper layer [m]"}
  cover   = {1.5, Min 0.1,  Max 20,  Step 0.1, Name "2Pipe/1Cover over the block [m]"}
  block   = {1.8, Min 0.2,  Max 10,  Step 0.1, Name "2Pipe/2Side of the block [m]"}
  outer   = {1.2, Min 0.1,  Max 8,   Step 0.1, Name "2Pipe/3Outer diameter of the pipe [m]"}
  wall    = {0.02, Min 0.002, Max 1, Step 0.005, Name "2Pipe/4Wall thickness of the pipe [m]"}
  around  = {48,  Min 16,   Max 720, Step 4,   Name "3Mesh/1Divisions round the pipe [-]"}
  through = {1,   Min 1,    Max 20,  Step 1,   Name "3Mesh/2Divisions through its wall [-]"}
  size_near = {0.12, Min 0.01, Max 2, Step 0.05, Name "3Mesh/3Element size at the block [m]"}
  size_far  = {1.0, Min 0.05, Max 10, Step 0.1, Name "3Mesh/4Element size far from it [m]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/5Order of the elements [-]"}
  refine  = {1, Min 0.25,   Max 16,  Step 0.5, Name "3Mesh/6All sizes are divided by [-]"}
];

axis = -cover - block / 2;
r = outer / 2; half = block / 2;
tiny = 1e-4;

If (2 * wall >= outer || outer > block - 0.05)
  Error("A pipe of outer = %g m, wall = %g m does not fit into a block of %g m.", outer, wall, block); Abort;
EndIf
If (layer < cover + block + size_near || height < layer + size_near || width < block + 2 * size_far)
  Error("layer = %g m must lie below the block, %g m deep, and above height = %g m.", layer, cover + block, height); Abort;
EndIf

// ---------------------------------------------------------------- ground, block and pipe

Rectangle(1) = {-width / 2, -layer, 0, width, layer};
Rectangle(2) = {-width / 2, -height, 0, width, height - layer};
Rectangle(3) = {-half, axis - half, 0, block, block};
Disk(4) = {0, axis, 0, r};
BooleanDifference(5) = { Surface{1}; Delete; }{ Surface{3}; };
BooleanDifference(6) = { Surface{3}; Delete; }{ Surface{4}; Delete; };
// four sectors of the wall, which always mesh into quadrilaterals
centre = newp; Point(centre) = {0, axis, 0};
For i In {0:3}
  c = Cos(i * Pi / 2); s = Sin(i * Pi / 2);
  out(i) = newp; Point(out(i)) = {r * c, axis + r * s, 0};
  in(i) = newp; Point(in(i)) = {(r - wall) * c, axis + (r - wall) * s, 0};
  spoke(i) = newl; Line(spoke(i)) = {in(i), out(i)};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  a = newl; Circle(a) = {out(i), centre, out(j)};
  b = newl; Circle(b) = {in(i), centre, in(j)};
  loop = newll; Curve Loop(loop) = {spoke(i), a, -spoke(j), -b};
  sectors() += news; Plane Surface(news) = {loop};
EndFor
top = newp; Point(top) = {0, axis + half, 0};
BooleanFragments{ Surface{2, 5, 6, sectors()}; Delete; }{ Point{top}; Delete; }

// ---------------------------------------------------------------- names, by place

t = tiny; w = width / 2 + t;
pipe() = Surface In BoundingBox{-r - t, axis - r - t, -t, r + t, axis + r + t, t};
box() = Surface In BoundingBox{-half - t, axis - half - t, -t, half + t, axis + half + t, t}; box() -= pipe();
lower() = Surface In BoundingBox{-w, -height - t, -t, w, -layer + t, t};
upper() = Surface{:}; upper() -= pipe(); upper() -= box(); upper() -= lower();
circle() = Abs(CombinedBoundary{ Surface{pipe()}; });
bore() = Curve In BoundingBox{-r + wall - t, axis - r + wall - t, -t, r - wall + t, axis + r - wall + t, t};
circle() -= bore();
square() = Abs(CombinedBoundary{ Surface{box()}; }); square() -= circle();
Physical Surface("pipe") = pipe();
Physical Surface("encasement") = box();
Physical Surface("ground_upper") = upper();
Physical Surface("ground_lower") = lower();
Physical Curve("pipe_face") = circle();
Physical Curve("block_face") = square();
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
Physical Point("CROWN") = Point In BoundingBox{-t, axis + r - t, -t, t, axis + r + t, t};
Physical Point("INVERT") = Point In BoundingBox{-t, axis - r - t, -t, t, axis - r + t, t};
Physical Point("BLOCK") = Point In BoundingBox{-t, axis + half - t, -t, t, axis + half + t, t};

// ---------------------------------------------------------------- mesh

spokes() = Abs(Boundary{ Surface{pipe()}; }); spokes() -= circle(); spokes() -= bore();
Transfinite Curve{circle(), bore()} = 1 + Ceil(refine * around / 4 - 1e-6);
Transfinite Curve{spokes()} = 1 + Ceil(refine * through - 1e-6);
Transfinite Surface{pipe()};
Recombine Surface{pipe()};
Field[1] = Distance; Field[1].CurvesList = {square(), circle()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = 0.2; Field[2].DistMax = 0.2 + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
