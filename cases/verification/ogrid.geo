// The paper's cilium for CiliaVal, in millimetres: an o-grid section, extruded through both
// segments. Mesh it with
//
//     gmsh -3 -format msh41 ogrid.geo -o ogrid.msh
//
// and name it in a case file: [models.solid] mesh = "ogrid.msh", mesh_unit = "1 mm".

R = 1.5;       // radius of the cilium
stub = 3;      // length of the lower segment
magnet = 17;   // length of the upper segment
inner = 0.8;   // half the diagonal of the inner square
around = 2;    // cells along a quarter of the rim
rings = 3;     // cells from the inner square to the rim

// The section: corners of the inner square and of the rim, every quarter turn.
Point(1) = {0, 0, 0};
For i In {0:3}
  a = Pi/4 + i*Pi/2;
  Point(10 + i) = {inner*Cos(a), inner*Sin(a), 0};
  Point(20 + i) = {R*Cos(a), R*Sin(a), 0};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Line(10 + i) = {10 + i, 10 + j};
  Circle(20 + i) = {20 + i, 1, 20 + j};
  Line(30 + i) = {10 + i, 20 + i};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Curve Loop(10 + i) = {30 + i, 20 + i, -(30 + j), -(10 + i)};
  Plane Surface(10 + i) = {10 + i};
EndFor
Curve Loop(1) = {10, 11, 12, 13};
Plane Surface(1) = {1};
Transfinite Curve {10:13, 20:23} = around + 1;
Transfinite Curve {30:33} = rings + 1 Using Progression 0.6;
Transfinite Surface {1, 10:13};
Recombine Surface {1, 10:13};

// One section mesh through both segments, finest at the clamped end and at the interface:
// Layers{ {cells, …}, {fraction of the length where they end, …} }.
section[] = {1, 10, 11, 12, 13};
lower[] = {};
upper[] = {};
mantle[] = {};
base[] = section[];
For s In {0:1}
  next[] = {};
  For i In {0:4}
    If (s == 0)
      out[] = Extrude {0, 0, stub} { Surface{section[i]};
                                     Layers{ {2, 2, 2}, {0.2, 0.8, 1} }; Recombine; };
      lower[] += out[1];
    Else
      out[] = Extrude {0, 0, magnet} { Surface{section[i]};
                                       Layers{ {2, 2, 7}, {0.04, 0.15, 1} }; Recombine; };
      upper[] += out[1];
    EndIf
    next[] += out[0];
    If (i > 0)
      mantle[] += out[3];  // the side that grows from the second curve of the loop: the rim
    EndIf
  EndFor
  section[] = next[];
EndFor

// The names by which CiliaVal knows the segments and the boundary.
Physical Volume("base") = lower[];
Physical Volume("magnet") = upper[];
Physical Surface("base") = base[];
Physical Surface("mantle") = mantle[];
Physical Surface("tip") = section[];
