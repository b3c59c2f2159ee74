// A horseshoe tunnel with a concrete lining in two layers of rock (plane strain). The lining slips along its arch only:
// the joint ends inside the solid, below it walls and invert slab are bonded to the rock.
//
// Frame: metres; y = 0 is the ground's surface, x = 0 the axis of the tunnel.
//
// Physical groups:
//   lining                      arch, walls and invert slab
//   rock_upper rock_lower       rock
//   arch                        outer face of the arch, from tip to tip of the joint
//   surface base side_left side_right   edges of the rock
//   CROWN SPRING INVERT         crown (outer face), left springline (inner face), middle of the slab (inner face)

SetFactory("OpenCASCADE");

DefineConstant[
  width   = {40,  Min 10,  Max 300, Step 1,   Name "1Rock/1Width [m]"}
  height  = {24,  Min 8,   Max 200, Step 1,   Name "1Rock/2Height [m]"}
  layer   = {4,   Min 0.5, Max 100, Step 0.5, Name "1Rock/3Depth of the bottom of the upper layer [m]"}
  crown   = {6,   Min 0.5, Max 100, Step 0.5, Name "2Tunnel/1Depth of the crown, outer face [m]"}
  radius  = {3.4, Min 0.5, Max 15,  Step 0.1, Name "2Tunnel/2Outer radius of the arch [m]"}
  walls   = {2,   Min 0.2, Max 15,  Step 0.1, Name "2Tunnel/3Height of the walls below the springline, slab included [m]"}
  lining  = {0.4, Min 0.05, Max 3,  Step 0.05, Name "2Tunnel/4Thickness of the lining [m]"}
  half    = {90,  Min 20,  Max 90,  Step 5,   Name "2Tunnel/5Joint from the crown to its tips on either side [degrees]"}
  size_near = {0.3, Min 0.02, Max 2, Step 0.05, Name "3Mesh/1Element size at the lining [m]"}
  size_far  = {2,   Min 0.05, Max 20, Step 0.5, Name "3Mesh/2Element size far from it [m]"}
  order   = {2, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/3Order of the elements [-]"}
  refine  = {1, Min 0.25, Max 16, Step 0.5, Name "3Mesh/4All sizes are divided by [-]"}
];

axis = -crown - radius;                // level of the springline
foot = axis - walls;                   // underside of the slab
in = radius - lining;                  // inner radius
tiny = 1e-4;

If (in <= 0 || walls <= lining)
  Error("lining = %g m leaves no opening: give less than radius = %g m and walls = %g m.", lining, radius, walls); Abort;
EndIf
If (layer > crown - size_near)
  Error("layer = %g m reaches the crown at %g m: end the upper layer above it.", layer, crown); Abort;
EndIf
If (height < -foot + size_near || width < 2 * radius + 2 * size_near)
  Error("The rock of %g m by %g m ends inside the tunnel, which is %g m deep.", width, height, -foot); Abort;
EndIf

// ---------------------------------------------------------------- rock and lining

Rectangle(1) = {-width / 2, -layer, 0, width, layer};
Rectangle(2) = {-width / 2, -height, 0, width, height - layer};
// outlines of the lining: outer and inner face, each an arch over three sides
For k In {0:1}
  r = k ? in : radius;
  low = k ? foot + lining : foot;
  p = newp;
  Point(p) = {0, axis, 0};
  Point(p + 1) = {r, low, 0};  Point(p + 2) = {r, axis, 0}; Point(p + 3) = {0, axis + r, 0};
  Point(p + 4) = {-r, axis, 0}; Point(p + 5) = {-r, low, 0};
  l = newl;
  Line(l) = {p + 1, p + 2};
  Circle(l + 1) = {p + 2, p, p + 3}; Circle(l + 2) = {p + 3, p, p + 4};
  Line(l + 3) = {p + 4, p + 5}; Line(l + 4) = {p + 5, p + 1};
  loops(k) = newll; Curve Loop(loops(k)) = {l, l + 1, l + 2, l + 3, l + 4};
EndFor
Plane Surface(3) = {loops(0), loops(1)};
Plane Surface(4) = {loops(0)};         // the hole in the rock
BooleanDifference(5) = { Surface{2}; Delete; }{ Surface{4}; Delete; };
// tips of the joint, and the middle of the slab
a = half * Pi / 180;
p = newp;
Point(p) = {radius * Sin(a), axis + radius * Cos(a), 0}; Point(p + 1) = {-radius * Sin(a), axis + radius * Cos(a), 0};
Point(p + 2) = {0, foot + lining, 0};
BooleanFragments{ Surface{1, 3, 5}; Delete; }{ Point{p : p + 2}; Delete; }

// ---------------------------------------------------------------- names, by place

w = width / 2 + tiny; t = tiny; x = radius + tiny;
ring() = Surface In BoundingBox{-x, foot - t, -t, x, axis + x, t};
upper() = Surface In BoundingBox{-w, -layer - t, -t, w, t, t};
lower() = Surface{:}; lower() -= ring(); lower() -= upper();
// outer face above the tips: the inner face of the arch lies lower by the lining at the crown, and inside by it at the tips
face() = Abs(CombinedBoundary{ Surface{ring()}; });
face() -= Curve In BoundingBox{-in - t, foot - t, -t, in + t, axis + in + t, t};
arch() = {};
For i In {0:#face() - 1}
  box() = BoundingBox Curve{face(i)};
  If (box(1) > axis + radius * Cos(a) - t && box(4) - box(1) > t)
    arch() += face(i);
  EndIf
EndFor
Physical Surface("lining") = ring();
Physical Surface("rock_upper") = upper();
Physical Surface("rock_lower") = lower();
Physical Curve("arch") = arch();
Physical Curve("surface") = Curve In BoundingBox{-w, -t, -t, w, t, t};
Physical Curve("base") = Curve In BoundingBox{-w, -height - t, -t, w, -height + t, t};
Physical Curve("side_left") = Curve In BoundingBox{-w, -height - t, -t, -width / 2 + t, t, t};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - t, -height - t, -t, w, t, t};
Physical Point("CROWN") = Point In BoundingBox{-t, axis + radius - t, -t, t, axis + radius + t, t};
Physical Point("SPRING") = Point In BoundingBox{-in - t, axis - t, -t, -in + t, axis + t, t};
Physical Point("INVERT") = Point In BoundingBox{-t, foot + lining - t, -t, t, foot + lining + t, t};

// ---------------------------------------------------------------- mesh

Field[1] = Distance; Field[1].CurvesList = {face()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = size_near / refine; Field[2].SizeMax = size_far / refine;
Field[2].DistMin = lining; Field[2].DistMax = lining + 5 * (size_far - size_near);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = order;
