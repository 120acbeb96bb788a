"""Everything about a run that can be set, with default, unit and meaning."""

from __future__ import annotations

from dataclasses import dataclass, fields

from carom import arguments, checks


@arguments.known
@dataclass(frozen=True, kw_only=True)
class Options:
    """Settings of `simulate`. Tolerances are relative to the scene's own lengths and speeds.

    Parameters
    ----------
    layer_width : float or None
        Width b of the boundary layer [m]. The motion after an impact does not depend on it; it sets
        the duration of an impact. Default None: 1e-5 of the size of the body.
    penetration : float
        Greatest penetration of the layer delta, as a part of its width, in (0, 1). Default 0.2, the
        paper's for the die. (Paper, section on the boundary layer.)
    layer_steps : int
        Cubic-spline steps through the layer for ``method="paper"``, shared by compression and
        restitution. Default 2, the paper's.
    add_layer_time : bool
        Add the duration of each impact to the clock. Default False: the impact takes no time.
    gap_tolerance : float
        An impact is located when the gap is within gap_tolerance * size of the body of zero, or within
        the round-off of the coordinates where that is larger. Default 1e-15.
    tie_tolerance : float
        Points of a body whose gaps differ by less than this part of its size strike together: as their mean
        if they move alike, else each for itself. Default 1e-9.
    multiple : {"simultaneous", "sequential", "newton"}
        Impacts while several points of the bodies are closed: their boundary layers are passed together
        (default, but for pairs of which `Scene.add_contact` says otherwise), or one blow after the other, the
        pair that approaches fastest first, or all by Newton's law in one contact problem (Moreau 1988), which
        is the quickest. (Mathematics page, part 2.)
    corner_tolerance : float
        Relative error of the velocities after a simultaneous impact. Default 1e-8.
    corner_exponent : float or None
        p of the normal force kappa d^p in a simultaneous impact. Default None: 1.5, Hertz's, where each of
        the points is one of a ball or an ellipsoid, whatever that touches; 1 where other points take part.
    hold : bool
        Hold a contact when all its remaining bounces would end within the present step. Default True.
        With False, a bouncing body that comes to rest stops the run with a status.
    rest_tolerance : float
        Bodies held at several points come to rest, exactly, when their speed is below this part of the speed
        that applied forces would give them in one step, or below what their contacts are solved to where that
        is more (up to ten times, in a crowd a thousand times); slip below it has stopped. Default 1e-9.
    energy_tolerance : float
        Energy that may come or go without a name in the ledger, as a part of the largest energy exchanged in
        the run: the greatest of kinetic energy, change of the potential, and each of the sums of loads,
        impacts, friction and bounces. What is beyond it is in `Solution.warnings`, and an `AccuracyWarning`;
        beyond a hundred times that a run ends as `Status.INACCURATE`. Watched after each step. A step of joined
        or loaded bodies by an explicit method that has more than 1e-3 of it by itself is taken in shorter
        ones. Default 1e-4. (Mathematics page, §1.12.)
    constraint_tolerance : float
        Greatest error of position (relative to the size of the bodies) and of velocity (relative
        to their speeds) that joints may have at the start. Default 1e-8.
    project_start : bool
        Take from the initial velocities what joints forbid: the least change in the kinetic metric. Default
        False: velocities that break a joint are refused.
    drop_tolerance : float
        A constraint row is redundant when its pivot is below this part of its own diagonal (of bodies of equal
        mass, where masses differ by more than 1e5). Default 1e-8.
    augmentation : float
        Augmented-Lagrangian parameter of the paper's methods and of reported reactions, as a part of
        each row's diagonal of A M^-1 A^T. Default 1e-3.
    natural_frequency : float
        beta of the paper's ODE form: the multipliers' equation has c_s = 2 zeta w m_RR and
        k_s = w^2 m_RR with w = beta / step. Only for ``method="paper-ode"``. Default 1.0.
    damping_ratio : float
        zeta of the paper's ODE form. Default 1.0.
    residual_tolerance : float
        Relative residual at which the block iteration of the paper's methods stops. Default 1e-15.
    max_iterations : int
        Most block iterations in one step of the paper's methods. Default 100.
    max_impacts_per_step : int
        Most impacts in one step; with more the step is taken whole (mathematics page, §3.9), and without
        `hold`, or with impacts that are not located, the run stops with a status. Default 1000. (More than
        1000 events at one instant count as too many, too.)
    max_cuts : int
        Most halvings of one step while an impact cannot be excluded; then the same. Default 40.
    max_step : float or None
        Longest step where tolerances choose [s]. Default None: where bodies may touch, a quarter of the time in
        which one falls by its size, .015 of it where there are several; else what the tolerances allow.
    """

    layer_width: float | None = None
    penetration: float = 0.2
    layer_steps: int = 2
    add_layer_time: bool = False
    gap_tolerance: float = 1e-15
    tie_tolerance: float = 1e-9
    multiple: str = "simultaneous"
    corner_tolerance: float = 1e-8
    corner_exponent: float | None = None
    hold: bool = True
    rest_tolerance: float = 1e-9
    energy_tolerance: float = 1e-4
    constraint_tolerance: float = 1e-8
    project_start: bool = False
    drop_tolerance: float = 1e-8
    augmentation: float = 1e-3
    natural_frequency: float = 1.0
    damping_ratio: float = 1.0
    residual_tolerance: float = 1e-15
    max_iterations: int = 100
    max_impacts_per_step: int = 1000
    max_cuts: int = 40
    max_step: float | None = None

    def __post_init__(self):
        if self.layer_width is not None:
            checks.number("layer_width", self.layer_width, above=0.0, unit="m")
        if self.max_step is not None:
            checks.number("max_step", self.max_step, above=0.0, unit="s")
        checks.number("penetration", self.penetration, above=0.0, below=1.0)
        for name in ("gap_tolerance", "tie_tolerance", "constraint_tolerance", "drop_tolerance"):
            checks.number(name, getattr(self, name), above=0.0, below=1.0)
        for name in ("rest_tolerance", "augmentation", "residual_tolerance"):
            checks.number(name, getattr(self, name), above=0.0, below=1.0)
        checks.number("energy_tolerance", self.energy_tolerance, above=0.0)
        for name in ("natural_frequency", "damping_ratio"):
            checks.number(name, getattr(self, name), least=0.0)
        checks.integer("layer_steps", self.layer_steps, least=1)
        for name in ("max_iterations", "max_impacts_per_step", "max_cuts"):
            checks.integer(name, getattr(self, name), least=1)
        checks.choice("multiple", self.multiple, ("simultaneous", "sequential", "newton"))
        checks.number("corner_tolerance", self.corner_tolerance, above=0.0, below=1.0)
        if self.corner_exponent is not None:
            checks.number("corner_exponent", self.corner_exponent, least=1.0, most=3.0)
        for name in ("add_layer_time", "hold", "project_start"):
            checks.flag(name, getattr(self, name))
        for f in fields(self):  # as Python's own numbers: of their types the loop is compiled
            value, kind = getattr(self, f.name), float if f.default is None else type(f.default)
            if value is not None:
                object.__setattr__(self, f.name, kind(value))

    def as_dict(self) -> dict:
        """All settings by name."""
        return {f.name: getattr(self, f.name) for f in fields(self)}
