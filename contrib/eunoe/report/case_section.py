"""The section that compares the simulated case with the apparatus of the measurements."""

from __future__ import annotations

from math import radians, tan

from .apparatus import Apparatus
from .measured import FullSize, Measured
from .page import Page
from .quantities import count, length, number, percent
from .run_folder import Layers


BRIDGED = 3.  # gap width over the largest diameter, below which a few particles bridge the gap
FIRST_OF_DENSIFICATION = 10  # layer from which the measured density rises


def _case_rows(layers: Layers, apparatus: Apparatus, full: FullSize,
               measured: Measured) -> list[tuple[str, str, str]]:
    a = apparatus
    rows = [("Measuring plate, length", length(a.plate_length), length(full.plate_length)),
            ("Measuring plate, depth", f"{length(a.depth)} ({'between walls' if a.side_walls else 'periodic'})",
             length(full.plate_depth)),
            ("Feedstock platform", length(a.platform_length), length(full.platform_length)),
            ("Transfer plate", length(a.transfer_length), length(full.transfer_length)),
            ("Exit plate", length(a.exit_length), length(full.exit_length)),
            ("Gap", length(a.gap), length(full.gap)),
            ("Spreader", f"half round, radius {length(a.front)}" if a.spreader == "half round"
             else f"flat blade, {length(a.rear)} thick",
             f"half round, radius {length(full.spreader_radius)}"),
            ("Clearance of the spreader", length(a.clearance), length(full.clearance)),
            ("Layers", f"{len(layers)} (0 to {layers.last})",
             f"{full.n_layers} (0 to {full.n_layers - 1})"),
            ("Layer thickness", length(a.layer_thickness), length(full.layer_thickness)),
            ("Spreading velocity", f"{number(1e3 * a.velocity)}\u00a0mm/s",
             f"{number(1e3 * full.velocity)}\u00a0mm/s"),
            ("Feedstock stroke, first and later",
             f"{length(a.first_stroke)}, {length(a.stroke)}",
             f"{length(full.first_stroke)}, {length(full.stroke)}")]
    if layers.particles[-1] > 0:
        mean_mass = layers.mass[-1] / layers.particles[-1]
        millions = measured.mean.sum() * full.full_layer_mass / mean_mass * 1e-6
        rows.append(("Particles on the plate at the end", count(layers.particles[-1]),
                     f"about {number(millions, 2)} million*"))
    return rows


def slopes_sentence(apparatus: Apparatus, full: FullSize, layer: int) -> str:
    """What the slopes at the powder's free ends mean for a plate of this length."""
    height = -apparatus.plate_height(layer)
    free = height - apparatus.lip
    if free <= 0. or apparatus.rim > 0.:
        return ""
    slopes = 2. * free / tan(radians(full.angle_of_repose))
    return (f"Below the lips ({length(apparatus.lip)} high) nothing holds the powder at the two "
            "ends of the plate, and it slopes into the gaps. At the powder's measured angle of "
            f"repose ({full.angle_of_repose:g}°), the two slopes of a bed {length(height)} deep "
            f"are {length(slopes)} long together: {percent(slopes / apparatus.plate_length, 0)} of "
            "this plate. The shorter the plate, the more the density of the later layers is that of its "
            "ends. In the apparatus of the measurements walls hold them ('rim width'). ")


def _bridging(apparatus: Apparatus, largest_diameter: float) -> str:
    """What it means if a gap is not much wider than the particles."""
    if largest_diameter <= 0. or apparatus.gap > BRIDGED * largest_diameter:
        return ""
    return (f"The gaps are only {number(apparatus.gap / largest_diameter, 2)} times as wide as the "
            f"largest particle ({length(largest_diameter)}): single particles can bridge them, "
            "which the full-size gaps do not allow. ")


def _differences(apparatus: Apparatus, full: FullSize) -> str:
    """Settings other than those of the measurement."""
    differing = [f"{name} {number(size * here, 4)}\u00a0{unit} (measured: "
                 f"{number(size * there, 4)}\u00a0{unit})"
                 for name, here, there, size, unit in full.differing(apparatus)]
    if not differing:
        return ""
    return ("The measurement does not apply to the settings of this run, which has "
            + ", ".join(differing) + ". ")


def add_case_section(page: Page, layers: Layers, apparatus: Apparatus, measured: Measured,
                     largest_diameter: float) -> None:
    """:param largest_diameter: of the powder (m); 0 if it is not known"""
    full = FullSize()
    page.heading("The simulated case and the full-size apparatus")
    page.table(("", "This run", "Full size"), _case_rows(layers, apparatus, full, measured))
    page.paragraph("* The measured mass over the mean mass of this run's particles on the plate. "
                   "Full size: Gaboriault et al. (2025).")
    ratio = full.plate_length / apparatus.plate_length
    text = ("The measured curve is of the full-size apparatus, whose plate is "
            + (f"{number(ratio, 2)} times as long as the simulated one. " if ratio > 1.05 else
               "no longer than the simulated one. "))
    text += _differences(apparatus, full)
    text += slopes_sentence(apparatus, full, layers.last)
    text += _bridging(apparatus, largest_diameter)
    text += ("The measured densification begins at about layer 10 and peaks at layer 18. In the "
             "simulations of Gaboriault et al. (2025) the peak is lower and comes earlier on a "
             "shorter plate, so its height and place can be compared between plates of equal "
             "length only.")
    if layers.last < FIRST_OF_DENSIFICATION:
        text += " This run ends before the layers in which it was measured."
    page.paragraph(text)
