"""The paper's method of three fields (`carom.dynamics.three_field`), with exact constraints or their ODE."""

from __future__ import annotations

from carom.dynamics.methods.kutta import rk4
from carom.model.method import THREE_FIELD, Definition, Method
from carom.options import Options


def paper(options: Options) -> Method:
    """Return the coefficients of the method with exact constraints."""
    return rk4()._replace(
        kind=THREE_FIELD,
        beta=options.natural_frequency,
        zeta=options.damping_ratio,
        augment=options.augmentation,
        tolerance=options.residual_tolerance,
        most=options.max_iterations,
    )


def paper_ode(options: Options) -> Method:
    """Return those of the method with the second-order equations of the multipliers."""
    return paper(options)._replace(ode=1)


METHODS = {
    "paper": Definition(THREE_FIELD, 2, paper),
    "paper-ode": Definition(THREE_FIELD, 2, paper_ode),
}
