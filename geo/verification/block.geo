// A block on a fixed foundation, and, where asked for, under a fixed ceiling or beside an elastic strip.
//
// Frame: metres; the whole is turned by `angle` about the origin, the middle of the block's foot, anticlockwise.
// The block is two elements wide. Foundation and ceiling are one element deep and have all their nodes held, so they are rigid.
// A case opens "foot" (and "head") into joints; one that does not leaves the block glued.
//
// Physical groups: block, foundation, ceiling, strip (faces); foot, head (block against foundation, ceiling);
//   block_sides, block_top (without a ceiling), block_right (without a strip); held (nodes of foundation and ceiling);
//   strip_end; FOOT, TOP (points in the middle of the block's foot and top; on a curve that opens they are the block's), M (middle of the block's left side).

SetFactory("Built-in");

DefineConstant[
  width   = {1,   Min 1e-4, Max 100, Step 0.1, Name "1Block/1Width [m]"}
  height  = {1,   Min 1e-4, Max 100, Step 0.1, Name "1Block/2Height [m]"}
  up      = {2,   Min 2, Max 10000, Step 2, Name "1Block/3Elements up, an even number [-]"}
  angle   = {0,   Min -80, Max 80, Step 5, Name "1Block/4Slope of the foundation [degrees]"}
  ceiling = {0,   Choices{0 = "none", 1 = "fixed"}, Name "2Around/1Ceiling"}
  strip   = {0,   Min 0, Max 100, Step 0.1, Name "2Around/2Length of an elastic strip on the right, 0 for none [m]"}
];

If (up != 2 * Floor(up / 2))
  Error("up = %g must be an even number: M lies in the middle of the block's side.", up); Abort;
EndIf

c = Cos(angle * Pi / 180);
s = Sin(angle * Pi / 180);
deep = width / 2; // of foundation and ceiling

// rows of nodes: 0 below the foundation, 1 foot, 2 middle, 3 top, 4 above the ceiling; columns left, middle, right
level() = {-deep, 0, height / 2, height, height + deep};
rows = ceiling ? 4 : 3;
For r In {0:rows}
  For k In {0:2}
    x = (k - 1) * width / 2;
    y = level(r);
    points() += newp; Point(newp) = {c * x - s * y, s * x + c * y, 0};
  EndFor
EndFor
For r In {0:rows}
  For k In {0:1}
    flat() += newl; Line(newl) = {points(3 * r + k), points(3 * r + k + 1)};
    Transfinite Curve{flat(2 * r + k)} = 2;
  EndFor
EndFor
For r In {0:rows - 1}
  For k In {0:2}
    upright() += newl; Line(newl) = {points(3 * r + k), points(3 * r + k + 3)};
    Transfinite Curve{upright(3 * r + k)} = (r == 1 || r == 2) ? 1 + up / 2 : 2;
  EndFor
EndFor
For r In {0:rows - 1}
  For k In {0:1}
    loop = newll;
    Curve Loop(loop) = {flat(2 * r + k), upright(3 * r + k + 1), -flat(2 * r + 2 + k), -upright(3 * r + k)};
    faces() += news; Plane Surface(news) = {loop};
  EndFor
EndFor
If (strip > 0) // on the upper half alone: below it would hold on to the foundation
  For r In {2:3}
    x = width / 2 + strip;
    y = level(r);
    ends() += newp; Point(newp) = {c * x - s * y, s * x + c * y, 0};
    long() += newl; Line(newl) = {points(3 * r + 2), ends(r - 2)};
    Transfinite Curve{long(r - 2)} = 2;
  EndFor
  far = newl; Line(far) = {ends(0), ends(1)};
  Transfinite Curve{far} = 1 + up / 2;
  loop = newll; Curve Loop(loop) = {long(0), far, -long(1), -upright(8)};
  strips() = {news}; Plane Surface(news) = {loop};
  Physical Surface("strip") = strips();
  Physical Curve("strip_end") = far;
EndIf

Physical Surface("foundation") = {faces(0), faces(1)};
Physical Surface("block") = {faces(2), faces(3), faces(4), faces(5)};
Physical Curve("foot") = {flat(2), flat(3)};
If (strip == 0)
  Physical Curve("block_sides") = {upright(3), upright(5), upright(6), upright(8)};
EndIf
held() = {flat(0), flat(1), upright(0), upright(1), upright(2)};
If (ceiling)
  Physical Surface("ceiling") = {faces(6), faces(7)};
  Physical Curve("head") = {flat(6), flat(7)};
  held() += {flat(8), flat(9), upright(9), upright(10), upright(11)};
Else
  Physical Curve("block_top") = {flat(6), flat(7)};
EndIf
Physical Curve("held") = held();
Physical Point("FOOT") = points(4);
Physical Point("TOP") = points(10);
Physical Point("M") = points(6);

Transfinite Surface{:};
Recombine Surface{:};
