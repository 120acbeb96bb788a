"""`Options`: all settings of a run, with default, unit and meaning."""

from __future__ import annotations

from dataclasses import dataclass, fields

from carom import arguments
from carom.fields import Flag, Integer, Number, NumberOrNone, Word, flag, integer, number, word


@arguments.known
@dataclass(frozen=True, kw_only=True)
class Options:
    """Settings of `simulate`. Tolerances are relative to the lengths and speeds of the scene.

    Parameters
    ----------
    layer_width : float or None
        Width b of the boundary layer [m]. It sets the duration of an impact; the motion after the impact does
        not depend on it. Default None: 1e-5 of the size of the body.
    penetration : float
        Maximum penetration delta of the layer, as a fraction of its width, in (0, 1). Default 0.2, the value
        of the paper for the die. (Paper, section on the boundary layer.)
    layer_steps : int
        Number of cubic-spline steps through the layer for ``method="paper"``, compression and restitution
        together. Default 2, as in the paper.
    add_layer_time : bool
        Add the duration of each impact to the clock. Default False: the impact takes no time.
    gap_tolerance : float
        An impact is located when the gap differs from zero by at most `gap_tolerance` times the size of the
        body, or by the round-off of the coordinates if that is larger. Default 1e-15.
    tie_tolerance : float
        Points of a body strike simultaneously if their gaps differ by less than this fraction of its size.
        They are replaced by their mean point if they move alike; otherwise each is a contact of its own.
        Default 1e-9.
    multiple : {"simultaneous", "sequential", "newton"}
        Law of multiple impact: of impacts while several contact points are closed. ``"simultaneous"``
        (default): their boundary layers are passed together; `Scene.add_contact` can choose otherwise for a
        pair. ``"sequential"``: one impact after another, starting with the pair that approaches fastest.
        ``"newton"``: all by Newton's law in one contact problem (Moreau 1988), the fastest to compute.
        (Mathematics page, part 2.)
    corner_tolerance : float
        Relative tolerance of the velocities after a simultaneous impact. Default 1e-8.
    corner_exponent : float or None
        Exponent p of the normal force kappa d^p in a simultaneous impact. Default None: 1.5 (Hertz) if a ball
        or an ellipsoid takes part in each of the contacts; 1 otherwise.
    hold : bool
        Make a contact persistent when all its remaining bounces would end within the present step. Default
        True. If False, a bouncing body that comes to rest ends the run with `Status.TOO_MANY_IMPACTS`.
    rest_tolerance : float
        Bodies with persistent contact at several points are set exactly to rest when their speed is below this
        fraction of the speed that the applied forces would give them in one step. If the accuracy of their
        contact problem is worse, that accuracy is the bound (at most ten times as large, in a crowd a thousand
        times). Slip below the bound becomes stick. Default 1e-9.
    energy_tolerance : float
        Allowed residual of the energy balance, i.e. energy that no entry of the ledger explains, as a fraction
        of the largest energy exchanged in the run: the greatest of kinetic energy, change of potential energy,
        and each of the sums over loads, impacts, friction and bounces. A larger residual gives an
        `AccuracyWarning` and a sentence in `Solution.warnings`; a residual more than a hundred times as large
        ends the run with `Status.INACCURATE`. The balance is checked after each step. With an explicit method,
        a step of joined or loaded bodies that alone uses more than 1e-3 of the allowed residual is repeated
        with shorter steps. Default 1e-4. (Mathematics page, §1.12.)
    constraint_tolerance : float
        Largest error of the joints at the start: of position relative to the size of the bodies, of velocity
        relative to their speeds. Default 1e-8.
    project_start : bool
        Project the start onto the joints: positions by Newton's method, velocities by the least change in the
        kinetic metric. Default False: a start that violates a joint is refused.
    drop_tolerance : float
        A constraint row is redundant if its pivot is below this fraction of its own diagonal entry (computed
        with equal masses if the masses differ by a factor of more than 1e5). Default 1e-8.
    augmentation : float
        Augmented-Lagrangian parameter of the paper's methods and of the reported reactions, as a fraction of
        the diagonal entry of A M^-1 A^T of each row. Default 1e-3.
    natural_frequency : float
        beta of the paper's ODE form: the multipliers' equation has c_s = 2 zeta w m_RR and
        k_s = w^2 m_RR with w = beta / step. Only for ``method="paper-ode"``. Default 1.0.
    damping_ratio : float
        zeta of the paper's ODE form. Default 1.0.
    residual_tolerance : float
        Relative residual at which the block iteration of the paper's methods stops. Default 1e-15.
    max_iterations : int
        Maximum number of block iterations in one step of the paper's methods. Default 100.
    max_impacts_per_step : int
        Maximum number of impacts in one step. If there are more, the step is repeated as one time-stepping
        (Moreau) step without event detection (mathematics page, §3.9); with ``hold=False``, or with impacts
        that are not located, the run ends with `Status.TOO_MANY_IMPACTS` instead. More than 1000 events at one
        instant count as too many as well. Default 1000.
    max_cuts : int
        Maximum number of times that one step is halved while an impact cannot be excluded; after that the same
        happens as for `max_impacts_per_step`, with `Status.STEP_CUT_TO_NOTHING`. Default 40.
    max_step : float or None
        Longest step for ``step="auto"`` [s]. Default None: if bodies may touch, a quarter of the time in which
        a body falls by its size, or 0.015 of that time if there are several bodies; otherwise no bound except
        the tolerances.
    """

    layer_width: NumberOrNone = number(None, above=0.0, unit="m")
    penetration: Number = number(0.2, above=0.0, below=1.0)
    layer_steps: Integer = integer(2, least=1)
    add_layer_time: Flag = flag(False)
    gap_tolerance: Number = number(1e-15, above=0.0, below=1.0)
    tie_tolerance: Number = number(1e-9, above=0.0, below=1.0)
    multiple: Word = word(("simultaneous", "sequential", "newton"), "simultaneous")
    corner_tolerance: Number = number(1e-8, above=0.0, below=1.0)
    corner_exponent: NumberOrNone = number(None, least=1.0, most=3.0)
    hold: Flag = flag(True)
    rest_tolerance: Number = number(1e-9, above=0.0, below=1.0)
    energy_tolerance: Number = number(1e-4, above=0.0)
    constraint_tolerance: Number = number(1e-8, above=0.0, below=1.0)
    project_start: Flag = flag(False)
    drop_tolerance: Number = number(1e-8, above=0.0, below=1.0)
    augmentation: Number = number(1e-3, above=0.0, below=1.0)
    natural_frequency: Number = number(1.0, least=0.0)
    damping_ratio: Number = number(1.0, least=0.0)
    residual_tolerance: Number = number(1e-15, above=0.0, below=1.0)
    max_iterations: Integer = integer(100, least=1)
    max_impacts_per_step: Integer = integer(1000, least=1)
    max_cuts: Integer = integer(40, least=1)
    max_step: NumberOrNone = number(None, above=0.0, unit="s")

    def as_dict(self) -> dict:
        """Return all settings by name."""
        return {f.name: getattr(self, f.name) for f in fields(self)}
