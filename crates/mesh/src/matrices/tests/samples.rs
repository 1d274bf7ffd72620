//! Files of one stiffness matrix in all formats.

/// File, its mapping if it needs one, and its format.
pub(super) type Sample = (&'static str, Option<&'static str>, &'static str);

/// Mapping in the form of Ansys.
pub(super) const MAPPING: &str = "    Matrix Eqn       Node        DOF
             1          5         UX
             2          5         UY
             3          5         UZ
             4          7         UX
";

/// Mapping in another order of rows, with commas.
const TURNED: &str = "# row, node, dof\n1, 7, 1\n2, 5, 3\n3, 5, 2\n4, 5, 1\n";

/// Files of the matrix of [`expected`](super::expected).
pub(super) const SAMPLES: [Sample; 17] = [
    (ABAQUS, None, "Abaqus matrix"),
    (ABAQUS_BOTH, None, "Abaqus matrix"),
    (LABELS, None, "Abaqus matrix"),
    ("1,1,4.\n2,1,-1.\n4,1,-2.5\n2,2,5.\n3,3,6.\n4,4,7.\n", Some(MAPPING), "Abaqus matrix"),
    ("1 1 7\n1 4 -2.5\n2 2 6\n3 3 5\n3 4 -1\n4 4 4\n4 1 -2.5\n4 3 -1", Some(TURNED), "Abaqus matrix"),
    (DMIG_SHORT, None, "Nastran DMIG"),
    (DMIG_LONG, None, "Nastran DMIG"),
    (DMIG_FREE, None, "Nastran DMIG"),
    (DMIG_SQUARE, None, "Nastran DMIG"),
    (OP4_DENSE, Some(MAPPING), "Nastran OUTPUT4"),
    (OP4_STRINGS, Some(MAPPING), "Nastran OUTPUT4"),
    (OP4_BIGMAT, Some(MAPPING), "Nastran OUTPUT4"),
    (OP4_SINGLE, Some(MAPPING), "Nastran OUTPUT4"),
    (MARKET, Some(MAPPING), "Matrix Market"),
    (MARKET_GENERAL, Some(TURNED), "Matrix Market"),
    (BOEING, Some(MAPPING), "Harwell-Boeing matrix"),
    (BOEING_RIGHT_SIDE, Some(MAPPING), "Harwell-Boeing matrix"),
];

const ABAQUS: &str = "** assembled by Job-1
*MATRIX, NAME=STIFF, TYPE=SYMMETRIC
5,1, 5,1, 4.000000000000000e+00
5,1, 5,2, -1.000000000000000e+00
5,2, 5,2, 5.000000000000000e+00
5,3, 5,3, 6.000000000000000e+00
5,1, 7,1, -2.500000000000000e+00
7,1, 7,1, 7.000000000000000e+00
";

const ABAQUS_BOTH: &str = "*Matrix, name=K, type=UNSYMMETRIC\r
7,1, 7,1, 7\r
7,1, 5,1, -2.5\r
5,1, 7,1, -2.5\r
5,1, 5,1, 4\r
5,2, 5,1, -1\r
5,1, 5,2, -1\r
5,2, 5,2, 5\r
5,3, 5,3, 6\r
";

const LABELS: &str =
    "5, 1, 5, 1, 4.D0\n5, 2, 5, 1, -1.D0\n5, 2, 5, 2, 5.\n5, 3, 5, 3, 6.\n7, 1, 5, 1, -2.5\n7, 1, 7, 1, 7.";

const DMIG_SHORT: &str = "$ punch
DMIG    KAAX           0       6       2       0
DMIG    KAAX           5       1               5       1     4.0
+              5       2    -1.0               7       1    -2.5
DMIG    KAAX           5       2               5       2     5.0
DMIG    KAAX           5       3               5       3   6.0+0
DMIG    KAAX           7       1               7       1   70.-1
ENDDATA
";

const DMIG_LONG: &str = "DMIG    KAAX           0       6       2       0                       4
DMIG*   KAAX                           5               1                *1
*1                     5               1 4.000000000D+00                *2
*2                     5               2-1.000000000D+00                *3
*3                     7               1-2.500000000D+00
GRID    5
DMIG*   KAAX                           5               2
*                      5               2 5.000000000D+00
DMIG*   KAAX                           5               3
*                      5               3 6.000000000D+00
DMIG*   KAAX                           7               1
*                      7               1 7.000000000D+00
";

const DMIG_FREE: &str = "dmig,kaax,0,6,1,0
dmig,kaax,5,1,,5,1,4.,,+
+,5,2,-1.,,7,1,-2.5
dmig,kaax,5,2,,5,2,5.
dmig,kaax,5,3,,5,3,6.
dmig,kaax,7,1,,7,1,7. $ last
";

const DMIG_SQUARE: &str = "DMIG,K,0,1,2,0
DMIG,K,5,1,,5,1,4.,,+
+,5,2,-1.,,7,1,-2.5
DMIG,K,5,2,,5,2,5.,,+
+,5,1,-1.
DMIG,K,5,3,,5,3,6.
DMIG,K,7,1,,7,1,7.,,+
+,5,1,-2.5
";

const OP4_DENSE: &str = "       4       4       6       2K       1P,2E12.4
       1       1       4
  4.0000E+00 -1.0000E+00
  0.0000E+00 -2.5000E+00
       2       1       2
 -1.0000E+00  5.0000E+00
       3       3       1
  6.0000E+00
       4       1       4
 -2.5000E+00  0.0000E+00
  0.0000E+00  7.0000E+00
       5       1       1
  1.0000E+00
";

const OP4_STRINGS: &str = "       4       4       6       2K       1P,2E12.4
       1       0       8
  327681
  4.0000E+00 -1.0000E+00
  196612
 -2.5000E+00
       2       0       3
  196610
  5.0000E+00
       3       0       3
  196611
  6.0000E+00
       4       0       3
  196612
  7.0000E+00
       5       0       1
  1.0000E+00
";

const OP4_BIGMAT: &str = "       4      -4       1       2K       1P,2D12.4
       1       0      10
       5       1
  4.0000D+00-10.0000D-01
       3       4
 -2.5000D+00
       2       0       6
       5       1
 -1.0000D+00  5.0000D+00
       3       0       4
       3       3
  6.0000D+00
       4       0       8
       3       1
 -2.5000D+00
       3       4
  7.0000D+00
       5       1       1
  1.0000D+00
";

const OP4_SINGLE: &str = "       4       4       6       1K       1P,5E16.9
       1       0       5
  196609
 4.000000000E+00-1.000000000E+00
  131076
-2.500000000E+00
       2       0       2
  131074
 5.000000000E+00
       3       0       2
  131075
 6.000000000E+00
       4       0       2
  131076
 7.000000000E+00
       5       0       1
 1.000000000E+00
";

const MARKET: &str = "%%MatrixMarket matrix coordinate real symmetric
% from Ansys
4 4 6
1 1 4.0
2 1 -1.0
4 1 -2.5
2 2 5.0
3 3 6.0
4 4 7.0
";

const MARKET_GENERAL: &str = "%%MatrixMarket matrix coordinate real general
4 4 8
1 1 7
1 4 -2.5
4 1 -2.5
2 2 6
3 3 5
3 4 -1
4 3 -1
4 4 4
";

const BOEING: &str = "Stiffness matrix from Ansys                                             STIFF
             6             1             1             3             0
RSA                        4             4             6             0
(10I4)          (10I4)          (2D12.4)
   1   4   5   6   7
   1   2   4   2   3   4
  4.0000D+00 -1.0000D+00
 -2.5000D+00  5.0000D+00
  6.0000D+00  7.0000D+00
";

const BOEING_RIGHT_SIDE: &str = "
             9             1             1             3             4
RUA                        4             4             8             0
(1P5I3)         (8I2)           (1P,3E14.6)         (1E12.4)
F                          1             0
  1  4  6  7  9
 1 2 4 1 2 3 1 4
  4.000000E+00 -1.000000E+00 -2.500000E+00
 -1.000000E+00  5.000000E+00  6.000000E+00
 -2.500000E+00  7.000000E+00
  0.0000E+00
";
