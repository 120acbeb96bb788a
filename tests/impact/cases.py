"""Problems shared by the tests of the impact: theory numbers, reference tables, random inputs."""

import csv
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from carom.law.impact_laws import NUMBERS, WITHOUT_PATH
from carom.scene.materials import IMPACT_LAWS

DATA = Path(__file__).parent.parent / "data" / "impacts"
LAWS = tuple(law for law in IMPACT_LAWS if NUMBERS[law] not in WITHOUT_PATH)  # with a path
KNOWN = ("newton", "poisson", "stronge")  # of the tables; equal where slip keeps its direction

# A fixed problem in space: critical friction 0.3207123399.
W_SPACE = np.array([[1.6, 0.5, -0.3], [0.5, 2.4, 0.4], [-0.3, 0.4, 1.9]])
U_SPACE = np.array([-1.0, 0.8, 0.5])


def planar(nn, nt, tt):
    """W of a planar problem in space: the second tangent is empty."""
    return np.array([[nn, nt, 0.0], [nt, tt, 0.0], [0.0, 0.0, 0.0]])


def rows(name):
    with (DATA / name).open() as file:
        for row in csv.DictReader(file):
            yield {k: v if k == "mode_newton" else float(v) for k, v in row.items()}


def cube_corner(row):
    """W, u of a row of cube_corner.csv, and the turn from world to contact axes (z, x, y)."""
    mass, edge = 0.016, 0.02
    x, y, z = row["rcx"], row["rcy"], row["rcz"]
    hat = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    W = turn @ (np.eye(3) / mass - hat @ hat / (mass * edge**2 / 6)) @ turn.T
    v = np.array([row["vx"], row["vy"], row["vz"]])
    w = np.array([row["wx"], row["wy"], row["wz"]])
    return 0.5 * (W + W.T), turn @ (v + np.cross(w, [x, y, z])), turn


def planar_rod(row):
    """W, u of a row of planar_rod.csv."""
    W = planar(row["Gnn"], row["Gtn"], row["Gtt"])
    return W, np.array([row["cn0"], row["ct0"], 0.0])


@st.composite
def problems(draw):
    """Any regular W (condition below about 1e4), u, friction and restitution."""
    unit = st.floats(-1.0, 1.0)
    A = np.array([draw(unit) for _ in range(9)]).reshape(3, 3)
    W = A @ A.T + 0.01 * np.eye(3)
    u = np.array([-draw(st.floats(0.05, 2.0)), draw(unit), draw(unit)])
    return 0.5 * (W + W.T), u, draw(st.floats(0.0, 2.0)), draw(st.floats(0.0, 1.0))
