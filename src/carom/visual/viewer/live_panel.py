"""The controls, charts and texts beside the motion in viser."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.visual.viewer.show import Show
from carom.visual.viewer.strikes import inside_of

POINTS = 400  # of the curves of energy
NOBODY = "nothing"
NO_IMPACT = "none"
INK, ORANGE, SKY, BLUE, GREEN = "#1d252c", "#E69F00", "#56B4E9", "#0072B2", "#009E73"


class LivePanel:
    """Controls, energy, the impacts, and the course of one impact; controls call methods of `view`."""

    def __init__(self, server, show: Show, view: Any):
        self.show, self.view, self.gui = show, view, server.gui
        gui = server.gui
        gui.configure_theme(control_width="large", show_logo=False, show_share_button=False)
        start, end = float(show.frames.time[0]), float(show.frames.time[-1])
        self.play = gui.add_button("Play")
        span = max(end - start, 1e-12)
        self.time = gui.add_slider(
            "time [s]", start, start + span, span / 5000, initial_value=start
        )
        self.speed = gui.add_number("speed", initial_value=float(view.speed), min=0.0)
        self.follow = gui.add_dropdown("follow", [NOBODY, *self._names()], initial_value=NOBODY)
        with gui.add_folder("Shown", expand_by_default=False):
            self.arrows = gui.add_checkbox("arrows", initial_value=True)
            self.paths = gui.add_checkbox("paths", initial_value=True)
            self.length = gui.add_slider("arrow length", 0.1, 10.0, 0.1, initial_value=1.0)
            self.through = gui.add_checkbox("see through bodies", initial_value=False)
        with gui.add_folder("Energy"):
            self._energy()
        with gui.add_folder("Impacts"):
            self.impact = gui.add_dropdown(
                "impact", [NO_IMPACT, *self._impacts()], initial_value=NO_IMPACT
            )
            self.step = gui.add_button_group("", ("previous", "next"))
            self.words = gui.add_markdown("Choose one, or click its mark.")
            self.velocity = self._curves(
                "velocity [m/s]", ("normal", "slip 1", "slip 2"), (INK, BLUE, ORANGE)
            )
            self.force = self._curves("force [N]", ("normal", "friction"), (INK, GREEN))
        self._connect()

    def show_time(self, t: float) -> None:
        """Move the slider, and write the energies."""
        self.time.value = t
        k = int(np.searchsorted(self.show.solution.t, t, side="right")) - 1
        solution = self.show.solution
        values = (
            solution.kinetic_energy[k],
            solution.potential_energy[k],
            solution.total_energy[k],
        )
        said = "kinetic {:.4g} J, potential {:.4g} J, total {:.4g} J".format(*values)
        self.energy.content = f"t = {t:.6g} s: {said}"

    def show_impact(self, k: int) -> None:
        """Show shown impact `k` from within; -1 for none."""
        labels = self.impact.options
        self.impact.value = labels[k + 1]
        self.velocity.visible = self.force.visible = False
        if k < 0:
            self.words.content = "Choose one, or click its mark."
            return
        record = self.show.solution.impacts[int(self.show.strikes.number[k])]
        before, after = record.relative_velocity_before[0], record.relative_velocity_after[0]
        speed, force = ("rad/s", "N m") if self.show.strikes.turning[k] else ("m/s", "N")
        said = [
            f"normal speed {before:.4g} to {after:.4g} {speed}, impulse "
            f"{np.linalg.norm(record.impulse):.4g} {force} s, energy {record.energy_change:.4g} J"
        ]
        inside = inside_of(self.show.solution, int(self.show.strikes.number[k]))
        if inside is None:
            said.append(f"Part of a multiple impact with {record.together} points.")
            if not record.located:
                said.append("Its time is the end of a time-stepping (Moreau) step.")
        else:
            said.append(", ".join((*inside.phases, f"{inside.time[-1]:.3g} s in its layer")))
            friction = np.linalg.norm(inside.force[:, 1:], axis=1)
            self.velocity.data = (inside.time, *inside.velocity.T.copy())
            self.force.data = (inside.time, inside.force[:, 0].copy(), friction)
            self.velocity.title, self.force.title = f"velocity [{speed}]", f"force [{force}]"
            self.velocity.visible = self.force.visible = True
        self.words.content = "  \n".join(said)

    def _connect(self) -> None:
        """Connect the controls to the view; changes by the view itself are not sent back."""
        view = self.view
        self.play.on_click(lambda _: view.play(not view.playing))

        def heard(handle, act):
            handle.on_update(lambda event: act(handle.value) if event.client is not None else None)

        heard(self.time, lambda t: (view.play(False), view.seek(t)))
        heard(self.speed, lambda s: setattr(view, "speed", max(s, 1e-9)))
        heard(self.follow, lambda name: view.follow(None if name == NOBODY else name))
        heard(self.arrows, lambda on: view.show_arrows(on))
        heard(self.paths, lambda on: view.stage.show_paths(on))
        heard(self.length, lambda factor: view.show_arrows(self.arrows.value, factor))
        heard(self.through, lambda on: view.stage.see_through(on))
        heard(self.impact, lambda label: view.choose(self.impact.options.index(label) - 1))
        self.step.on_click(lambda _: view.next_impact(1 if self.step.value == "next" else -1))

    def _names(self) -> list[str]:
        return [body.name for body in self.show.solution.scene.bodies]

    def _impacts(self) -> list[str]:
        """Return a label for each shown impact."""
        strikes, impacts = self.show.strikes, self.show.solution.impacts
        rows = zip(strikes.number, strikes.contact)
        return [f"{k + 1}: {impacts.time[k]:.6g} s, {name}" for k, name in rows]

    def _energy(self) -> None:
        solution, last = self.show.solution, len(self.show.solution.t) - 1
        rows = np.unique(np.linspace(0, last, min(last + 1, POINTS)).round().astype(int))
        columns = solution.potential_energy, solution.kinetic_energy, solution.total_energy
        self.energy = self.gui.add_markdown("")
        self.gui.add_uplot(
            (solution.t[rows], *(column[rows] for column in columns)),
            _series(("potential [J]", "kinetic [J]", "total [J]"), (SKY, ORANGE, INK)),
            scales={"x": {"time": False}}, height=190,
        )  # fmt: skip

    def _curves(self, title: str, names, colours):
        empty = tuple(np.zeros(2) for _ in range(len(names) + 1))
        return self.gui.add_uplot(
            empty, _series(names, colours), title=title, scales={"x": {"time": False}}, height=170,
            visible=False,
        )  # fmt: skip


def _series(names, colours) -> tuple:
    """Return curves of a chart: the first is the time."""
    curves: list[Any] = [{"label": "time [s]"}]
    for name, colour in zip(names, colours):
        curve: dict[str, Any] = {"label": name, "stroke": colour, "width": 2}
        curve["points"] = {"show": False}
        curves.append(curve)
    return tuple(curves)
