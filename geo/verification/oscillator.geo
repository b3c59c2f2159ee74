// Separate bars of one element each, side by side: with nu = 0, a held base and rollers, each is a mass on a spring.
//
// Frame: metres; y = 0 is the held base, y = 1 the free top.
// Bar i: stiffness k = E width / 1, mass m = rho width / 3 (consistent), so omega = sqrt(3 E / rho).
// The bars are narrow, so that their second mode (left top node against right one) is far above the first.
//
// Physical groups: bar_1 ... bar_4 (faces), top_1 ... top_4 (curves), base, sides; P1 ... P4 (points on the tops).

SetFactory("Built-in");

DefineConstant[
  bars  = {1,    Min 1,    Max 4, Step 1, Name "1Number of bars [-]"}
  width = {0.02, Min 0.001, Max 1, Step 0.01, Name "2Width of a bar [m]"}
];

For i In {1:bars}
  x = 0.5 * (i - 1);
  a = newp; Point(a) = {x, 0, 0};
  b = newp; Point(b) = {x + width, 0, 0};
  c = newp; Point(c) = {x + width, 1, 0};
  d = newp; Point(d) = {x, 1, 0};
  bottom = newl; Line(bottom) = {a, b};
  right = newl; Line(right) = {b, c};
  top = newl; Line(top) = {c, d};
  left = newl; Line(left) = {d, a};
  loop = newll; Curve Loop(loop) = {bottom, right, top, left};
  face = news; Plane Surface(face) = {loop};
  Transfinite Curve{bottom, right, top, left} = 2;
  Transfinite Surface{face};
  Recombine Surface{face};
  bases() += bottom;
  rollers() += {right, left};
  Physical Surface(Sprintf("bar_%g", i)) = face;
  Physical Curve(Sprintf("top_%g", i)) = top;
  Physical Point(Sprintf("P%g", i)) = d;
EndFor
Physical Curve("base") = bases();
Physical Curve("sides") = rollers();
