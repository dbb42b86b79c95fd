"""The errors that the photometric cues predict for each system under a setting."""

from collections.abc import Callable

from published import CLAIMS
from settings import Setting
from torch import Tensor

import multilens as ml
from multilens.app.build import build_problem
from multilens.app.given import read_given

FULL_WELL_PER_UM2 = 3400
"""Electrons; as in the presets, which tell where it is from."""

READ_NOISE, EFFICIENCY = 3.0, 0.5
"""As in the presets."""

OAK_D_LIMITS = ml.PairLimits(max_disparity=95 * 0.003)
"""95 pixels of 3 um."""

Errors = dict[str, Tensor]
"""mm at every depth, infinite where nothing is measured, by how it is measured."""


def preset(system: str) -> ml.Problem:
    """Give a system as its preset has it."""
    return build_problem(read_given([f"experiment=devices/{system}"]).config)


LENSES = {system: preset(system).lenses for system in ("d3s", "focal_track", "oak_d")}


def sensor(pitch_um: float) -> ml.Sensor:
    """Give the sensor that the presets assume, with pixels of another size."""
    return ml.Sensor(pitch_um, FULL_WELL_PER_UM2 * pitch_um**2, READ_NOISE, EFFICIENCY)


def middle_focus(system: str, quarter: float) -> float:
    """Give the in-focus depth that lies so far, in dioptres, from the far end of the published range to the near one, mm."""
    claim = next(claim for claim in CLAIMS if claim.system == system)
    return 1 / (1 / claim.far + quarter * (1 / claim.near - 1 / claim.far))


def both(stereo: Tensor, defocus: Tensor) -> Tensor:
    """Give the error of two independent measurements together, infinite where neither measures."""
    return (stereo**-2 + defocus**-2) ** -0.5


def d3s(setting: Setting, depths: Tensor) -> Errors:
    """Two lenses 4 mm apart, focused apart: stereo of two unequal blurs, and defocus between the two images."""
    change, pitch = setting.power_change, setting.pitch_um
    focus, focal_length = middle_focus("d3s", setting.quarter), LENSES["d3s"][0].focal_length
    radius = focal_length / (2 * setting.f_number)
    lens = ml.Lens(focal_length, (radius, radius), sensor=sensor(pitch))
    foci = [1 / (1 / focus + sign * change / 2000) for sign in (1, -1)]
    scene = setting.scene(pitch)
    layout = ml.Layout([lens.position for lens in LENSES["d3s"]], [radius] * 2, foci)
    stereo = ml.PhotometricStereo(scene)(layout, [lens] * 2, depths)[0]
    # The two images are what one lens would take with its focus between the two, changed by their difference.
    defocus = ml.PhotometricDefocus(scene, change)(_alone(radius, focus), [lens], depths)[0]
    return {"stereo": stereo, "defocus": defocus, "both": both(stereo, defocus)}


def focal_split(setting: Setting, depths: Tensor) -> Errors:
    """Two sensors behind one lens and a beam splitter, which gives each of them half of the light."""
    change, pitch, focal_length = setting.power_change, setting.pitch_um, setting.focal_length
    radius = focal_length / (2 * setting.f_number)
    lens = ml.Lens(focal_length, (radius, radius), sensor=sensor(pitch))
    layout = _alone(radius, middle_focus("focal_split", setting.quarter))
    cue = ml.PhotometricDefocus(setting.scene(pitch), change, light_share=0.5)
    return {"defocus": cue(layout, [lens], depths)[0]}


def focal_track(setting: Setting, depths: Tensor) -> Errors:
    """One lens whose focus swings: about the depth that is asked for, or about one that stays."""
    lens = ml.Lens(LENSES["focal_track"][0].focal_length, (2.0, 2.0), sensor=LENSES["focal_track"][0].sensor)
    cue = ml.PhotometricDefocus(setting.scene(11.72), setting.power_change)
    # In focus the error is Z^2 times what does not depend on Z: one depth tells all.
    first = depths[:1]
    in_focus = cue(_alone(2.0, first.item()), [lens], first)[0] * (depths / first) ** 2
    stays = cue(_alone(2.0, middle_focus("focal_track", 0.5)), [lens], depths)[0]
    return {"focus follows": in_focus, "focus stays": stays}


def oak_d(setting: Setting, depths: Tensor) -> Errors:
    """A stereo pair with a limit of disparity, both lenses fixed in focus."""
    lenses = LENSES["oak_d"]
    radius = lenses[0].aperture_radius[0]
    layout = ml.Layout([lens.position for lens in lenses], [radius] * 2, [392.0] * 2)
    return {"stereo": ml.PhotometricStereo(setting.scene(3.0), OAK_D_LIMITS)(layout, lenses, depths)[0]}


def _alone(radius: float, focus: float) -> ml.Layout:
    return ml.Layout([[0.0, 0.0]], [radius], [focus])


PREDICT: dict[str, Callable[[Setting, Tensor], Errors]] = {
    "d3s": d3s,
    "focal_split": focal_split,
    "focal_track": focal_track,
    "oak_d": oak_d,
}
