// One to four parallel pipes in three horizontal layers of ground, in cross-section (plane strain).
//
// Frame: metres; y = 0 is the ground's surface, y = -height its base, x = 0 the axis of symmetry.
// Mesh:  the right half is meshed and mirrored, so geometry and mesh are symmetric about x = 0.
//        The mesh is conforming where pipe meets ground: coralpipe opens the interface curves itself.
//        core_width and core_height bound a part whose mesh stays as it is while the ground around it grows
//        (`coralpipe domain`); refine makes all elements smaller alike (`coralpipe converge`).
//
// Physical groups (a case file refers to these names and to nothing else):
//   layer_1 layer_2 layer_3           ground, from the top
//   pipe_left pipe_2 pipe_3 pipe_right  pipes from left to right: the outermost are _left and _right,
//                                     those between are numbered from the left; a single pipe is pipe_left
//   interface_left ... _right         outer face of the pipe of the same name
//   surface base side_left side_right edges of the ground
//   A C     crown and invert of pipe_left, outer face
//   H K     left and right springline of pipe_left, outer face
//   L I     left and right springline of pipe_right, outer face
//           (a single pipe is both: L is then the same point as H, and I the same as K)
//
// By hand:  gmsh -2 twin_pipes.geo -setnumber spacing 3 -setnumber General.AbortOnError 4 -o twin_pipes.msh

SetFactory("OpenCASCADE");

DefineConstant[
  width         = {25,  Min 2,    Max 500, Step 1,   Name "1Ground/1Width [m]"}
  height        = {15,  Min 1,    Max 500, Step 1,   Name "1Ground/2Height [m]"}
  layer_1_depth = {3,   Min 0.1,  Max 500, Step 0.5, Name "1Ground/3Depth of the bottom of layer 1 [m]"}
  layer_2_depth = {7,   Min 0.2,  Max 500, Step 0.5, Name "1Ground/4Depth of the bottom of layer 2 [m]"}
  pipes         = {2,   Min 1,    Max 4,   Step 1,   Name "2Pipes/1Number of pipes [-]"}
  crown         = {4,   Min 0.05, Max 100, Step 0.1, Name "2Pipes/2Depth of the crown [m]"}
  spacing       = {2.4, Min 0.2,  Max 100, Step 0.1, Name "2Pipes/3Spacing, axis to axis [m]"}
  outer         = {1.2, Min 0.1,  Max 20,  Step 0.1, Name "2Pipes/4Outer diameter [m]"}
  inner         = {0.8, Min 0.05, Max 20,  Step 0.1, Name "2Pipes/5Inner diameter [m]"}
  around        = {64,  Min 16,   Max 720, Step 4,   Name "3Mesh/1Divisions round a pipe [-]"}
  through       = {4,   Min 1,    Max 50,  Step 1,   Name "3Mesh/2Divisions through the wall [-]"}
  size_near     = {0.06, Min 0.005, Max 10, Step 0.01, Name "3Mesh/3Element size at the pipes [m]"}
  size_far      = {0.40, Min 0.01,  Max 50, Step 0.05, Name "3Mesh/4Element size far from the pipes [m]"}
  ground_nodes  = {4, Choices{3 = "T3 (order 2: T6)", 4 = "Q4 (order 2: Q8)"}, Name "3Mesh/5Ground element, corners [-]"}
  order         = {1, Choices{1 = "linear", 2 = "quadratic"}, Name "3Mesh/6Order of the elements [-]"}
  refine        = {1, Min 0.25, Max 16, Step 0.5, Name "3Mesh/7All sizes are divided by [-]"}
  core_width    = {0, Min 0, Max 500, Step 1, Name "3Mesh/8Width of the part whose mesh is kept (0: all) [m]"}
  core_height   = {0, Min 0, Max 500, Step 1, Name "3Mesh/9Height of the part whose mesh is kept (0: all) [m]"}
];

growth = 0.15;                        // growth of the element size per metre away from a pipe [-]
radius = outer / 2;
axis   = -(crown + radius);           // level of the pipes' axes
tiny   = 1e-4;                        // half-width of the boxes that find things by place
level() = {0, -layer_1_depth, -layer_2_depth, -height};
half_row = (pipes - 1) * spacing / 2; // from x = 0 to the outermost axis

// ---------------------------------------------------------------- what cannot be built

If (pipes != 1 && pipes != 2 && pipes != 3 && pipes != 4)
  Error("pipes = %g cannot be drawn: give 1, 2, 3 or 4.", pipes); Abort;
EndIf
If (order != 1 && order != 2)
  Error("order = %g is no element order: give 1 (linear) or 2 (quadratic).", order); Abort;
EndIf
If (ground_nodes != 3 && ground_nodes != 4)
  Error("ground_nodes = %g is no ground element: give 3 (triangles) or 4 (quadrilaterals).", ground_nodes); Abort;
EndIf
If (around < 16 || through < 1 || around != Floor(around) || through != Floor(through))
  Error("around = %g and through = %g cannot divide a pipe: give whole numbers, at least 16 and 1.", around, through); Abort;
EndIf
// Length of an interface element; also the least distance of anything from a pipe, and the thinnest layer:
// thinner strips of ground mesh into slivers.
edge = Pi * outer / around;
If (core_width > 0 && half_row + radius > core_width / 2 - edge)
  Error("core_width = %g m cuts through the pipes, which reach %g m from the axis of symmetry: widen it, or give 0 for none.", core_width, half_row + radius); Abort;
EndIf
If (core_height > 0 && (core_height < layer_2_depth + edge || core_height < crown + outer + edge))
  Error("core_height = %g m must lie below layer_2_depth = %g m and the pipes' invert at %g m: deepen it, or give 0 for none.", core_height, layer_2_depth, crown + outer); Abort;
EndIf
If (size_near <= 0 || size_far < size_near)
  Error("size_near = %g m and size_far = %g m: sizes must be positive, and the far one not the smaller.", size_near, size_far); Abort;
EndIf
If (inner <= 0 || inner >= outer)
  Error("inner = %g m leaves no pipe wall inside outer = %g m: give 0 < inner < outer.", inner, outer); Abort;
EndIf
If (layer_1_depth < edge || layer_2_depth < layer_1_depth + edge || height < layer_2_depth + edge)
  Error("The layers end at layer_1_depth = %g m, layer_2_depth = %g m and height = %g m: each must lie deeper than the one before by at least an interface element, %g m.", layer_1_depth, layer_2_depth, height, edge); Abort;
EndIf
If (crown < edge)
  Error("crown = %g m brings the pipes out of the ground: bury them by at least an interface element, %g m.", crown, edge); Abort;
EndIf
If (crown + outer > height - edge)
  Error("The invert at %g m comes through the base at height = %g m: raise the pipes or deepen the ground.", crown + outer, height); Abort;
EndIf
If (pipes > 1 && spacing < outer + edge)
  Error("spacing = %g m makes the pipes of outer = %g m overlap or touch: leave at least an interface element between them, spacing >= %g m.", spacing, outer, outer + edge); Abort;
EndIf
If (half_row + radius > width / 2 - edge)
  Error("%g pipes reach %g m from the axis of symmetry, out of the ground of width = %g m: widen the ground or narrow the spacing.", pipes, half_row + radius, width); Abort;
EndIf
For i In {1:2}
  // A line that grazes a pipe leaves a wedge of ground with no angle to mesh; one just beside a springline, an element of no length.
  crown_gap = Fabs(level(i) + crown);
  invert_gap = Fabs(level(i) + crown + outer);
  axis_gap = Fabs(level(i) - axis);
  If (crown_gap < edge || invert_gap < edge)
    Error("layer_%g_depth = %g m grazes the pipes' crown at %g m or invert at %g m: keep it at least an interface element, %g m, above or below.", i, -level(i), crown, crown + outer, edge); Abort;
  EndIf
  If (axis_gap > 1e-9 && axis_gap < edge / 3)
    Error("layer_%g_depth = %g m passes too close to the pipes' springlines at %g m: put it there exactly, or at least %g m away.", i, -level(i), -axis, edge / 3); Abort;
  EndIf
EndFor

// ---------------------------------------------------------------- ground and pipes

// Lines at which the ground is cut: layers, the axis of symmetry, and the core where it ends inside.
down() = level();
If (core_height > 0 && core_height < height - tiny)
  down() = {0, -layer_1_depth, -layer_2_depth, -core_height, -height};
EndIf
across() = {0, width / 2};
If (core_width > 0 && core_width < width - tiny)
  across() = {0, core_width / 2, width / 2};
EndIf
For j In {1:#across() - 1}
  For i In {1:#down() - 1}
    size_x = across(j) - across(j - 1); size_y = down(i - 1) - down(i);
    strips() += news; Rectangle(news) = {-across(j), down(i), 0, size_x, size_y};
    strips() += news; Rectangle(news) = {across(j - 1), down(i), 0, size_x, size_y};
  EndFor
EndFor

// A wall is cut into four-sided sectors (these always mesh into quadrilaterals) at its quarter points and
// where a layer line meets its outer face. All pipes lie at one depth, so the angles serve each of them.
angle() = {0, Pi / 2, Pi, 3 * Pi / 2};
For i In {1:2}
  sine = (level(i) - axis) / radius;
  If (Fabs(sine) < 1 && Fabs(sine) * radius > 1e-9)
    angle() += {Asin(sine) + (sine < 0 ? 2 * Pi : 0), Pi - Asin(sine)};
  EndIf
EndFor
angle() = Unique(angle());
n = #angle();

For p In {1:pipes}
  x = (p - 1) * spacing - half_row;
  bores() += news; Disk(news) = {x, axis, 0, radius};
  centre = newp; Point(centre) = {x, axis, 0};
  outside() = {}; inside() = {}; spokes() = {};
  For i In {0:n - 1}
    outside() += newp; Point(newp) = {x + radius * Cos(angle(i)), axis + radius * Sin(angle(i)), 0};
    inside() += newp; Point(newp) = {x + inner / 2 * Cos(angle(i)), axis + inner / 2 * Sin(angle(i)), 0};
    spokes() += newl; Line(newl) = {inside(i), outside(i)};
  EndFor
  For i In {0:n - 1}
    j = (i + 1) % n;
    a = newl; Circle(a) = {outside(i), centre, outside(j)};
    b = newl; Circle(b) = {inside(i), centre, inside(j)};
    loop = newll; Curve Loop(loop) = {spokes(i), a, -spokes(j), -b};
    sectors() += news; Plane Surface(news) = {loop};
  EndFor
EndFor

strips() = BooleanDifference{ Surface{strips()}; Delete; }{ Surface{bores()}; Delete; };
BooleanFragments{ Surface{strips(), sectors()}; Delete; }{} // ground and wall share their edges from here on

// ---------------------------------------------------------------- names

// The Boolean operations may have renumbered everything; places stay, so things are found by their boxes.

ground() = Surface{:};
For p In {1:pipes}
  x = (p - 1) * spacing - half_row;
  name = Sprintf("%g", p);
  If (p == 1)
    name = "left";
  ElseIf (p == pipes)
    name = "right";
  EndIf
  wall() = Surface In BoundingBox{x - radius - tiny, axis - radius - tiny, -tiny, x + radius + tiny, axis + radius + tiny, tiny};
  ring() = Abs(CombinedBoundary{ Surface{wall()}; });
  ring() -= Curve In BoundingBox{x - inner / 2 - tiny, axis - inner / 2 - tiny, -tiny, x + inner / 2 + tiny, axis + inner / 2 + tiny, tiny};
  ground() -= wall();
  walls() += wall();
  Physical Surface(StrCat("pipe_", name)) = wall();
  Physical Curve(StrCat("interface_", name)) = ring();
EndFor

For i In {1:3}
  layer() = Surface In BoundingBox{-width / 2 - tiny, level(i) - tiny, -tiny, width / 2 + tiny, level(i - 1) + tiny, tiny};
  layer() -= walls();
  Physical Surface(Sprintf("layer_%g", i)) = layer();
EndFor

Physical Curve("surface") = Curve In BoundingBox{-width / 2 - tiny, -tiny, -tiny, width / 2 + tiny, tiny, tiny};
Physical Curve("base") = Curve In BoundingBox{-width / 2 - tiny, -height - tiny, -tiny, width / 2 + tiny, -height + tiny, tiny};
Physical Curve("side_left") = Curve In BoundingBox{-width / 2 - tiny, -height - tiny, -tiny, -width / 2 + tiny, tiny, tiny};
Physical Curve("side_right") = Curve In BoundingBox{width / 2 - tiny, -height - tiny, -tiny, width / 2 + tiny, tiny, tiny};

t = tiny; top = axis + radius; bottom = axis - radius; x = -half_row;
Physical Point("A") = Point In BoundingBox{x - t, top - t, -t, x + t, top + t, t};
Physical Point("C") = Point In BoundingBox{x - t, bottom - t, -t, x + t, bottom + t, t};
x = -half_row - radius; Physical Point("H") = Point In BoundingBox{x - t, axis - t, -t, x + t, axis + t, t};
x = -half_row + radius; Physical Point("K") = Point In BoundingBox{x - t, axis - t, -t, x + t, axis + t, t};
x = half_row - radius;  Physical Point("L") = Point In BoundingBox{x - t, axis - t, -t, x + t, axis + t, t};
x = half_row + radius;  Physical Point("I") = Point In BoundingBox{x - t, axis - t, -t, x + t, axis + t, t};

// ---------------------------------------------------------------- mesh

// Walls: the same number of elements along both arcs of a sector, so the outer face decides.
For p In {1:pipes}
  x = (p - 1) * spacing - half_row;
  wall() = Surface In BoundingBox{x - radius - tiny, axis - radius - tiny, -tiny, x + radius + tiny, axis + radius + tiny, tiny};
  ring() = Abs(CombinedBoundary{ Surface{wall()}; });
  bore() = Curve In BoundingBox{x - inner / 2 - tiny, axis - inner / 2 - tiny, -tiny, x + inner / 2 + tiny, axis + inner / 2 + tiny, tiny};
  ring() -= bore();
  spokes() = Abs(Boundary{ Surface{wall()}; });
  spokes() -= ring();
  spokes() -= bore();
  For c In {0:#ring() - 1}
    length() = Mass Curve{ring(c)};
    Transfinite Curve{ring(c)} = 1 + Ceil(refine * length(0) / edge - 1e-6);
  EndFor
  For c In {0:#bore() - 1}
    length() = Mass Curve{bore(c)};
    Transfinite Curve{bore(c)} = 1 + Ceil(refine * length(0) / (Pi * inner / around) - 1e-6);
  EndFor
  Transfinite Curve{spokes()} = 1 + Ceil(refine * through - 1e-6);
EndFor
Transfinite Surface{walls()};
Recombine Surface{walls()};

// Ground: size_near within a ring of elements about each pipe, growing from there.
For p In {1:pipes}
  Field[p] = Ball;
  Field[p].XCenter = (p - 1) * spacing - half_row;
  Field[p].YCenter = axis;
  Field[p].Radius = radius + 2 * size_near;
  Field[p].VIn = size_near / refine;
  Field[p].VOut = size_far / refine;
  Field[p].Thickness = (size_far - size_near) / growth;
  around_pipes() += p;
EndFor
Field[pipes + 1] = Min;
Field[pipes + 1].FieldsList = {around_pipes()};
Background Field = pipes + 1;
Mesh.MeshSizeExtendFromBoundary = 0; // sizes come from the field alone
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;                  // frontal Delaunay
If (ground_nodes == 4)
  Recombine Surface{ground()};
EndIf

// The left half is the mirror image of the right one. (If you draw something unsymmetric, take this loop out.)
For s In {0:#ground() - 1}
  box() = BoundingBox Surface{ground(s)};
  If (box(3) < tiny) // on the left
    twin() = Surface In BoundingBox{-box(3) - tiny, box(1) - tiny, -tiny, -box(0) + tiny, box(4) + tiny, tiny};
    twin() -= walls();
    Periodic Surface{ground(s)} = {twin(0)} Affine{-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1};
  EndIf
EndFor

Mesh.ElementOrder = order;
Mesh.SecondOrderIncomplete = 1; // Q8, not Q9
