"""One planar frictional impact in closed form (Routh's method; Wang and Mason 1992).

With p the normal impulse and W (2, 2) over (normal, tangent), ``du/dp = W (1, tau)``: slip has
``tau = -mu sign(u_t)``; stick ``tau = -W_nt/W_tt`` if that is within mu; else slip goes on with
``tau = -mu sign(W_nt)``. So u is linear in p but for one kink, where the first slip ends.
"""

from __future__ import annotations

import numpy as np


class Path:
    """Velocity against normal impulse: ``u0 + rate1 p`` up to the kink, ``rate2`` from there on."""

    def __init__(self, W, u0, mu):
        self.u0 = np.array(u0, float)
        sign, stick = np.sign(self.u0[1]), -W[0, 1] / W[1, 1]
        self.tau1 = -mu * sign
        self.rate1 = W @ [1.0, self.tau1]
        ends = mu > 0.0 and self.rate1[1] * sign < 0.0
        self.kink = -self.u0[1] / self.rate1[1] if ends else np.inf
        self.tau2 = stick if abs(stick) <= mu else -mu * np.sign(W[0, 1])
        self.rate2 = W @ [1.0, self.tau2]
        after = "stick" if abs(stick) <= mu else "reversal"
        self.at_kink = self.u0 + self.rate1 * self.kink if ends else None
        self.after = after if ends else "slip"
        if min(self.rate1[0], self.rate2[0]) <= 0.0:
            raise ValueError("a jam: the normal velocity does not grow with the impulse")

    def velocity(self, p):
        """Return u at the normal impulse p; the slip at and after a stick is exactly zero."""
        if p <= self.kink:
            return self.u0 + self.rate1 * p
        u = self.at_kink + self.rate2 * (p - self.kink)
        u[1] = 0.0 if self.after == "stick" else self.rate2[1] * (p - self.kink)
        return u

    def impulse(self, p):
        """Return the impulse (normal, tangent) when the normal one is p."""
        first = min(p, self.kink)
        return np.array([p, self.tau1 * first + self.tau2 * (p - first)])

    def work(self, p):
        """Return ``int_0^p u_n dp``: two trapezes."""
        first = min(p, self.kink)
        work = first * 0.5 * (self.u0[0] + self.velocity(first)[0])
        if p > first:
            work += (p - first) * 0.5 * (self.at_kink[0] + self.velocity(p)[0])
        return work

    def where_normal_velocity_is(self, value):
        """Return p at which u_n, which grows, has `value`."""
        p = (value - self.u0[0]) / self.rate1[0]
        if p <= self.kink:
            return p
        return self.kink + (value - self.at_kink[0]) / self.rate2[0]

    def where_restitution_work_is(self, value):
        """Return the p at which the work since the end of compression (u_n = 0) is `value`."""
        p_c = self.where_normal_velocity_is(0.0)
        if p_c >= self.kink:
            return p_c + np.sqrt(2.0 * value / self.rate2[0])
        p = p_c + np.sqrt(2.0 * value / self.rate1[0])
        if p <= self.kink:
            return p
        u_n = self.at_kink[0]
        rest = value - 0.5 * u_n * (self.kink - p_c)  # = u_n q + rate2 q^2/2, q beyond the kink
        return self.kink + 2.0 * rest / (u_n + np.sqrt(u_n**2 + 2.0 * self.rate2[0] * rest))


def impact(W, u, friction, restitution, law):
    """Return a dict: velocity and impulse (normal, tangent), what the slip did, p_c, the works."""
    u = np.asarray(u, float)
    path = Path(np.asarray(W, float), u, float(friction))
    p_c = path.where_normal_velocity_is(0.0)
    work_c = path.work(p_c)
    if law == "newton":
        p_f = path.where_normal_velocity_is(-restitution * u[0])
    elif law == "poisson":
        p_f = (1.0 + restitution) * p_c
    else:  # stronge: the work given back is e^2 times the work taken
        p_f = path.where_restitution_work_is(-(restitution**2) * work_c)
    return dict(
        velocity=path.velocity(p_f),
        impulse=path.impulse(p_f),
        slip=path.after if path.kink < p_f else "slip",
        compression_impulse=p_c,
        compression_work=work_c,
        restitution_work=path.work(p_f) - work_c,
    )
