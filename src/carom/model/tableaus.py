"""Tableaus of Runge-Kutta methods, each once: stages A, weights b, and weights of errors E.

In a step of length h, with k_i = f(y + h sum of A_ij k_j), the end is y + h sum of b_i k_i, and an estimate of
its error h sum of E_i k_i: the difference of the weights from those of a lower order. A test has the conditions
of all orders that are stated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Tableau(NamedTuple):
    """A method of S stages with e estimates of its error."""

    A: np.ndarray  # (S, S)
    b: np.ndarray  # (S,)
    E: np.ndarray  # (e, S): b minus the weights of the method of a lower order
    order: int
    lower: tuple[int, ...]  # (e,) the orders of the methods of the errors


def tableau(rows, b, errors, order: int, lower: tuple[int, ...]) -> Tableau:
    """Return a tableau from the rows of A as far as they are not zero."""
    A = np.zeros((len(b), len(b)))
    for i, row in enumerate(rows):
        A[i, : len(row)] = row
    E = np.array(errors, dtype=float).reshape(-1, len(b))
    return Tableau(A, np.array(b, dtype=float), E, order, lower)


_LAST = [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]
#: RK5(4)7M of Dormand and Prince (1980); its last stage is at the end of the step
DORMAND_PRINCE = tableau(
    [
        [],
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        _LAST,
    ],
    [*_LAST, 0.0],
    [-71 / 57600, 0.0, 71 / 16695, -71 / 1920, 17253 / 339200, -22 / 525, 1 / 40],
    5,
    (4,),
)  # fmt: skip

#: DOP853 (Hairer, Norsett and Wanner 1993), with its errors of order 5 and 3
HAIRER = tableau(
    [
        [],
        [0.05260015195876773],
        [0.0197250569845379, 0.0591751709536137],
        [0.02958758547680685, 0.0, 0.08876275643042054],
        [0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792],
        [0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242],
        [0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
        [
            0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
            0.008273789163814023
        ],
        [
            0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
            20.154067550477894, -43.48988418106996
        ],
        [
            0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
            15.279233632882423, -33.28821096898486, -0.020331201708508627
        ],
        [
            -0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
            -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196
        ],
        [
            2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
            27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636
        ],
    ],
    [
        0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
        0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259
    ],
    [
        [
            0.01312004499419488, 0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502,
            1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571,
            -0.022355307863886294
        ],
        [
            -0.18980075407240762, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
            -0.4226823213237919, -0.1521609496625161, 0.20136540080403034, 0.02265179219836082
        ],
    ],
    8,
    (5, 3),
)  # fmt: skip

#: two more weights of errors of order 5 of the same method. They are orthogonal to that of Hairer, Norsett and
#: Wanner, and as long. All others of order 5 in the stages 1 and 6 to 12 are sums of these three, since the
#: conditions of order 5 have rank 5 in these eight stages. The error of a kink in a step is 0 at some places
#: for each of them, at none for all
OF_KINKS = np.zeros((2, 12))
OF_KINKS[:, [0, *range(5, 12)]] = [
    [
        0.10811085774398249, 1.321260679178407, -1.4362321178001727, 0.43247567966819084,
        -0.5906359511484547, -0.21553430200705073, 0.5669693132364955, -0.18641415887139787,
    ],
    [
        0.008524524078584065, 0.0, -0.35075634949146817, 0.5124376382320663, 1.4832628604629525,
        -1.4485372944881887, -0.2663307153563819, 0.06139933656243606,
    ],
]  # fmt: skip

_ENDS = [82889 / 524892, 0.0, 15625 / 83664, 69875 / 102672, -2260 / 8211, 1 / 4]
_LOWER = [
    4586570599 / 29645900160, 0.0, 178811875 / 945068544, 814220225 / 1159782912, -3700637 / 11593932,
    61727 / 225920,
]  # fmt: skip
_DEFECT = np.array(_ENDS) - np.array(_LOWER)
#: ARK4(3)6L[2]SA of Kennedy and Carpenter (2003), its implicit part: L-stable, stiffly accurate, stage order 2
KENNEDY_CARPENTER = tableau(
    [
        [],
        [1 / 4, 1 / 4],
        [8611 / 62500, -1743 / 31250, 1 / 4],
        [5012029 / 34652500, -654441 / 2922500, 174375 / 388108, 1 / 4],
        [15267082809 / 155376265600, -71443401 / 120774400, 730878875 / 902184768, 2285395 / 8070912, 1 / 4],
        _ENDS,
    ],
    _ENDS,
    _DEFECT,
    4,
    (3,),
)  # fmt: skip
#: and its explicit part, which has the same weights: the terms of both may be different functions
KENNEDY_CARPENTER_EXPLICIT = tableau(
    [
        [],
        [1 / 2],
        [13861 / 62500, 6889 / 62500],
        [-116923316275 / 2393684061468, -2731218467317 / 15368042101831, 9408046702089 / 11113171139209],
        [
            -451086348788 / 2902428689909, -2682348792572 / 7519795681897,
            12662868775082 / 11960479115383, 3355817975965 / 11060851509271,
        ],
        [
            647845179188 / 3216320057751, 73281519250 / 8382639484533, 552539513391 / 3454668386233,
            3354512671639 / 8306763924573, 4040 / 17871,
        ],
    ],
    _ENDS,
    _DEFECT,
    4,
    (3,),
)  # fmt: skip

#: implicit Euler as the second of two stages
CLOSING = tableau([[], [0.0, 1.0]], [0.0, 1.0], [], 1, ())
