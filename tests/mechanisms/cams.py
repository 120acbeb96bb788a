"""Cams and followers of tests, and the motion of a follower from its lift alone, with events of its own."""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import carom

G = 9.81


class Lift:
    """A lift of the cam angle, periodic, and its two derivatives, from a trigonometric polynomial."""

    def __init__(self, height, count=512):
        samples = [height(2.0 * math.pi * k / count) for k in range(count)]
        c = np.fft.rfft(samples) / count
        c[1:] *= 2.0
        self.n = np.flatnonzero(np.abs(c) > 1e-17)
        self.c = c[self.n]

    def __call__(self, angle, order=0):
        return float(np.real(np.sum(self.c * (1j * self.n) ** order * np.exp(1j * self.n * angle))))


def flat_height(radius):
    """Return the height of a flat face over the axis of a cam r(a) for each cam angle."""

    def height(angle):
        def place(a):
            return radius(a) * math.sin(a + angle)

        grid = np.linspace(0.0, 2.0 * math.pi, 2000)
        values = [place(a) for a in grid]
        return highest(place, grid[int(np.argmax(values))], grid[1])

    return height


def highest(place, middle, spacing):
    """Return the greatest value of a smooth function near a place, by the root of its derivative."""

    def slope(a, h=1e-3):
        d = [(place(a + k * h) - place(a - k * h)) / (2 * k * h) for k in (1, 2, 3)]
        return 1.5 * d[0] - 0.6 * d[1] + 0.1 * d[2]

    return place(brentq(slope, middle - spacing, middle + spacing, xtol=1e-14))


def roller_height(radius, r):
    """Return the height of the axis of a roller of radius r, on the vertical line over the axis of a cam."""

    def height(angle):
        # the roller is as low as it can be: the highest y with a point of the cam at the distance r
        def place(a):
            x, y = radius(a) * math.cos(a + angle), radius(a) * math.sin(a + angle)
            return y + math.sqrt(max(r * r - x * x, 0.0)) if abs(x) < r else -math.inf

        grid = np.linspace(0.0, 2.0 * math.pi, 1000)
        values = [place(a) for a in grid]
        return highest(place, grid[int(np.argmax(values))], grid[1])

    return height


class Jumps(NamedTuple):
    """The motion of a follower: heights at the times asked for, times of leaving and of impacts."""

    y: np.ndarray
    leaves: list
    lands: list


def follower(lift, omega, times, load=G, stiffness=0.0, e=0.0):
    """Return the motion of a follower of mass 1 on a lift; `load` and spring pull it down [m/s^2, 1/s^2]."""

    def on(t, order=0):
        return lift(omega * t, order) * omega**order

    rest = on(0.0)

    def push(t):  # of the cam while it touches
        return on(t, 2) + load + stiffness * (on(t) - rest)

    y, leaves, lands, t, end = np.empty(len(times)), [], [], 0.0, times[-1]
    state = None  # in flight: height and speed
    while t < end:
        if state is None:
            grid = np.linspace(t, end, 2000)
            values = np.array([push(s) for s in grid])
            drop = np.flatnonzero(values[1:] < 0.0)
            there = np.flatnonzero(times >= t)
            if values[0] < 0.0 or len(drop) == 0:
                last = t if values[0] < 0.0 else end
            else:
                last = brentq(push, grid[drop[0]], grid[drop[0] + 1], xtol=1e-15)
            for k in there:
                if times[k] <= last:
                    y[k] = on(times[k])
            if last >= end:
                break
            leaves.append(last)
            t, state = last, (on(last), on(last, 1))
        eps = 1e-6 / omega  # it is above at once
        ball = solve_ivp(
            lambda s, z: (z[1], -load - stiffness * (z[0] - rest)), (t, end + 1e-9), state, method="DOP853",
            rtol=1e-13, atol=1e-15, dense_output=True,
            events=_landing(on, t + eps),
        )  # fmt: skip
        there = (times >= t) & (times <= ball.t[-1])
        y[there] = ball.sol(times[there])[0]
        if not len(ball.t_events[0]):
            break
        t = brentq(
            lambda s, sol=ball.sol: sol(s)[0] - on(s),
            ball.t_events[0][0] - 1e-7,
            ball.t_events[0][0] + 1e-7,
            xtol=1e-15,
        )
        speed = ball.sol(t)[1] - on(t, 1)
        lands.append(t)
        state = (on(t), on(t, 1) - e * speed) if e > 0.0 else None
    return Jumps(y, leaves, lands)


def _landing(on, first):
    def gap(s, z):
        return z[0] - on(s) if s > first else 1.0

    gap.terminal, gap.direction = True, -1
    return gap


def cam_scene(cam, omega, follower, height, mass=1.0, stiffness=0.0, e=0.0, offset=(0.0, 0.0)):
    """Return a scene of a driven cam about z through the origin and a follower that slides along y.

    `offset` is the mass centre of the cam at the start.
    """
    scene = carom.Scene(gravity=(0, -G, 0))
    x, y = offset
    wheel = scene.add_body(
        cam, mass=1.0, position=(x, y, 0), velocity=(-omega * y, omega * x, 0), angular_velocity=(0, 0, omega),
        name="cam"
    )  # fmt: skip
    axle = scene.add_joint(
        carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 0, 1)), carom.GROUND, wheel, name="axle"
    )
    scene.add_constraint(carom.constraints.Driver(axle, rate=omega), name="drive")
    rod = scene.add_body(
        follower, mass=mass, position=(0, height[0], 0), velocity=(0, height[1], 0), name="follower"
    )
    slide = scene.add_joint(carom.joints.Prismatic(axis=(0, 1, 0)), carom.GROUND, rod, name="guide")
    if stiffness:
        scene.add_force(carom.forces.JointSpring(slide, stiffness=stiffness), name="spring")
    scene.add_contact(rod, wheel, restitution=e, friction=0.0, name="lift")
    return scene
