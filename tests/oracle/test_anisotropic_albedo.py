"""How far an anisotropic lobe is from the isotropic one whose albedo it is given (docs/design/lighting.md).

Albedos of one bounce are integrals over visible normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"), with
Smith's masking and shadowing at once. Alphas are those of KHR_materials_anisotropy.
"""
import numpy as np
import pytest

ROUGHNESSES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


def points(count: int) -> np.ndarray:
    """Roberts's R2 sequence: the integrals below are within 0.001 of those by four times as many points."""
    g = 1.32471795724474602596
    i = np.arange(count)
    return np.stack([(0.5 + i / g) % 1, (0.5 + i / g**2) % 1], axis=1)


POINTS = points(1 << 14)


def albedo(view: np.ndarray, ax: float, ay: float) -> float:
    def masking(w: np.ndarray) -> np.ndarray:
        slope2 = ((ax * w[..., 0]) ** 2 + (ay * w[..., 1]) ** 2) / np.maximum(w[..., 2], 1e-9) ** 2
        return (np.sqrt(1 + slope2) - 1) / 2

    stretched = np.array([ax * view[0], ay * view[1], view[2]])
    stretched /= np.linalg.norm(stretched)
    level = np.hypot(stretched[0], stretched[1])
    first = np.array([-stretched[1], stretched[0], 0]) / level if level > 0 else np.array([1.0, 0, 0])
    second = np.cross(stretched, first)
    radius, angle, part = np.sqrt(POINTS[:, 0]), 2 * np.pi * POINTS[:, 1], (1 + stretched[2]) / 2
    a = radius * np.cos(angle)
    b = (1 - part) * np.sqrt(1 - a * a) + part * radius * np.sin(angle)
    c = np.sqrt(np.maximum(0, 1 - a * a - b * b))
    normal = a[:, None] * first + b[:, None] * second + c[:, None] * stretched
    normal *= [ax, ay, 1]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    light = 2 * (normal @ view)[:, None] * normal - view
    ratio = (1 + masking(view)) / (1 + masking(view) + masking(light))
    return float(np.where(light[:, 2] > 0, ratio, 0).mean())


def direction(theta_deg: float, phi_deg: float) -> np.ndarray:
    theta, phi = np.radians([theta_deg, phi_deg])
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def alphas(roughness: float, strength: float) -> tuple[float, float]:
    along = roughness**2
    return along + (1 - along) * strength**2, along


def of_all_directions(ax: float, ay: float) -> float:
    return float(np.hypot(ax, ay) / np.sqrt(2))


def of_the_view(ax: float, ay: float, phi_deg: float) -> float:
    phi = np.radians(phi_deg)
    return float(np.hypot(ax * np.cos(phi), ay * np.sin(phi)))


def errors(strength: float, angles: tuple[int, ...], by_view: bool = False) -> list[float]:
    found = []
    for roughness in ROUGHNESSES:
        ax, ay = alphas(roughness, strength)
        for theta in angles:
            for phi in (0, 22.5, 45, 67.5, 90):
                view = direction(theta, phi)
                alpha = of_the_view(ax, ay, phi) if by_view else of_all_directions(ax, ay)
                found.append(albedo(view, ax, ay) / albedo(view, alpha, alpha) - 1)
    return found


# Rounding of the percentages that the documentation states.
ROUNDING = 0.005


@pytest.mark.parametrize("strength", [0.25, 0.5])
def test_weak_anisotropy_is_within_a_tenth(strength: float) -> None:
    assert np.abs(errors(strength, (0, 30, 60, 75, 85))).max() < 0.10 + ROUNDING


def test_full_anisotropy_to_60_degrees() -> None:
    assert np.abs(errors(1.0, (0, 30, 60))).max() == pytest.approx(0.13, abs=ROUNDING)


def test_full_anisotropy_at_grazing_angles() -> None:
    assert min(errors(1.0, (85,))) == pytest.approx(-0.38, abs=ROUNDING)


def test_projected_roughness_is_further_off() -> None:
    assert min(errors(1.0, (0, 30, 60, 75, 85), by_view=True)) == pytest.approx(-0.47, abs=ROUNDING)
