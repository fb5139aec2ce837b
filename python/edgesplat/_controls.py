"""Controls of a view in a notebook, with ipywidgets (6 or later). Sliders and buttons move the eye; they work in
JupyterLab and in the classic notebook."""

from __future__ import annotations

from typing import Any, Callable

import ipywidgets

from ._core import Error
from ._view import View


def controls(view: View) -> ipywidgets.Widget:
    """The picture of `view` with its controls beside it."""
    return _Controls(view).panel_with_picture


class _Controls:
    """Sliders show the view's values. Each change draws one picture; the front end sends the next change after the last
    picture is done."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.is_updating = False
        height, width = view.picture.color.shape[:2]
        size = {"width": f"{width}px", "height": f"{height}px", "flex": "0 0 auto"}
        self.image = ipywidgets.Image(format="png", value=view.png(), layout=size)
        self.message = ipywidgets.HTML()
        mode = ipywidgets.ToggleButtons(options=[("orbit", False), ("fly", True)], value=view.flying)
        mode.observe(self.set_mode, "value")
        self.sliders = {
            name: self.slider(name, getattr(view, name), low, high, lambda value, name=name: setattr(view, name, value))
            for name, low, high in (
                ("turn", -180.0, 180.0),
                ("tilt", -90.0, 90.0),
                ("distance", view.diagonal / 1000, max(2 * view.diagonal, 2 * view.distance)),
            )
        }
        self.step = ipywidgets.FloatSlider(
            description="step, mm", value=view.diagonal / 50, min=view.diagonal / 1000, max=view.diagonal / 4
        )
        self.step.step = view.diagonal / 1000
        surfaces = [self.surface(place) for place in range(len(view.iso_values))]
        divider = self.slider("wipe", view.wipe, 0.0, 1.0, lambda place: setattr(view, "wipe", place))
        against = ipywidgets.Dropdown(description="against", options=["plain", "raycast"], value=view.against)
        against.observe(lambda change: self.draw(lambda: setattr(view, "against", change["new"])), "value")
        home = ipywidgets.Button(description="first view", icon="home")
        first = view.camera
        home.on_click(lambda _: self.draw(lambda: setattr(view, "camera", first)))
        sliders, buttons = self.sliders.values(), self.step_buttons()
        panel = [mode, *sliders, buttons, self.step, *surfaces, divider, against, home, self.message]
        self.panel_with_picture = ipywidgets.HBox([self.image, ipywidgets.VBox(panel)])
        self.show_state()

    def slider(self, name: str, value: float, low: float, high: float, act: Callable[[float], None]) -> Any:
        slider = ipywidgets.FloatSlider(description=name, value=value, min=low, max=high, step=(high - low) / 1000)
        slider.observe(lambda change: self.draw(lambda: act(change["new"])), "value")
        return slider

    def surface(self, place: int) -> Any:
        def act(value: float) -> None:
            values = self.view.iso_values
            values[place] = value
            self.view.iso_values = values

        volume = self.view.volume
        return self.slider(f"iso {place + 1}", self.view.iso_values[place], volume.min, volume.max, act)

    def step_buttons(self) -> Any:
        """Buttons that move the eye by one step."""
        rows = (
            (("left", "arrow-left", {"right": -1}), ("right", "arrow-right", {"right": 1})),
            (("up", "arrow-up", {"up": 1}), ("down", "arrow-down", {"up": -1})),
            (("forward", "plus", {"forward": 1}), ("back", "minus", {"forward": -1})),
        )
        return ipywidgets.VBox([ipywidgets.HBox([self.step_button(*button) for button in row]) for row in rows])

    def step_button(self, name: str, icon: str, direction: dict[str, int]) -> Any:
        button = ipywidgets.Button(description=name, icon=icon)
        button.on_click(
            lambda _: self.draw(
                lambda: self.view.move(**{axis: sign * self.step.value for axis, sign in direction.items()})
            )
        )
        return button

    def set_mode(self, change: Any) -> None:
        self.view.flying = change["new"]

    def draw(self, act: Callable[[], None]) -> None:
        """Executes a control's action and shows the new picture, or the error."""
        if self.is_updating:
            return
        try:
            act()
            self.image.value = self.view.png()
        except Error as error:
            self.show_message(str(error))
        else:
            self.show_state()

    def show_state(self) -> None:
        self.is_updating = True
        for name, slider in self.sliders.items():
            slider.value = min(max(getattr(self.view, name), slider.min), slider.max)
        self.is_updating = False
        statistics = self.view.picture.statistics
        eye = ", ".join(f"{v:.4g}" for v in self.view.eye)
        time = f"; {statistics.frame_ms:.0f} ms" if statistics.frame_ms is not None else ""
        self.show_message(f"eye {eye} mm{time}")

    def show_message(self, text: str) -> None:
        escaped = text.replace("&", "&amp;").replace("<", "&lt;")
        self.message.value = f'<div style="max-width: 20em; line-height: 1.3">{escaped}</div>'
