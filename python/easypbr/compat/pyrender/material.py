"""Materials and textures, as glTF has them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _easypbr
from ...errors import ArgumentError
from .changes import Noted
from .colors import color, decoded


class Sampler:
    """How a texture is sampled; EasyPBR filters and repeats all of them."""

    name: str | None
    magFilter: int | None
    minFilter: int | None
    wrapS: int
    wrapT: int

    def __init__(
        self,
        name: str | None = None,
        magFilter: int | None = None,
        minFilter: int | None = None,
        wrapS: int = 10497,
        wrapT: int = 10497,
    ) -> None:
        self.name, self.magFilter, self.minFilter, self.wrapS, self.wrapT = name, magFilter, minFilter, wrapS, wrapT


class Texture(Noted):
    """An image: an array, or an image of Pillow. `source_channels` says which channels it has: "R", "RG", "RGB", "RGBA"."""

    name: str | None
    sampler: Sampler | None
    source_channels: str | None
    width: int | None
    height: int | None

    def __init__(
        self,
        name: str | None = None,
        sampler: Sampler | None = None,
        source: Any = None,
        source_channels: str | None = None,
        width: int | None = None,
        height: int | None = None,
        **_: Any,
    ) -> None:
        self.name, self.sampler, self.source_channels = name, sampler, source_channels
        self.width, self.height = width, height
        self.source = source

    @property
    def pixels(self) -> NDArray[Any] | None:
        """Height x width (x channels), uint8; None: there is no image."""
        if self.source is None:
            return None
        source = self.source
        mode = getattr(source, "mode", None)
        if mode is not None and mode not in ("L", "RGB", "RGBA"):  # Palettes and other modes of Pillow.
            has_alpha = "A" in mode or "transparency" in getattr(source, "info", {})
            source = source.convert("L" if mode == "1" else "RGBA" if has_alpha else "RGB")
        array = np.asarray(source)
        if array.dtype.kind in "fb":
            array = np.clip(array * 255.0 + 0.5, 0, 255)
        return array.astype(np.uint8)

    def is_transparent(self, cutoff: float = 1.0) -> bool:
        """Whether the alpha of a pixel is below `cutoff`, 0 to 1."""
        pixels = self.pixels
        return pixels is not None and pixels.ndim == 3 and pixels.shape[2] == 4 and bool(pixels[:, :, 3].min() < cutoff * 255)


def texture_of(given: Any, channels: str) -> Texture | None:
    """A Texture of a Texture, an array or an image."""
    if given is None or isinstance(given, Texture):
        return given
    return Texture(source=given, source_channels=channels)


def _fraction(number: float) -> float:
    return float(np.clip(number, 0, 1))


#: Textures of materials and the channels that they are made of.
_CHANNELS = {
    "normalTexture": "RGB", "occlusionTexture": "R", "emissiveTexture": "RGB", "baseColorTexture": "RGBA",
    "metallicRoughnessTexture": "GB", "diffuseTexture": "RGBA", "specularGlossinessTexture": "RGBA",
}  # fmt: skip
_ALPHA_MODES = ("OPAQUE", "MASK", "BLEND")


# The order of the fields is that of pyrender's positional arguments.
@dataclass(eq=False, repr=False)
class Material(Noted):
    """What all materials have."""

    name: str | None = None
    normalTexture: Any = None
    occlusionTexture: Any = None
    emissiveTexture: Any = None
    emissiveFactor: Any = None
    alphaMode: Any = None
    alphaCutoff: Any = None
    doubleSided: bool = False
    smooth: bool = True
    wireframe: bool = False

    def __setattr__(self, name: str, value: Any) -> None:
        if name in _CHANNELS:
            value = texture_of(value, _CHANNELS[name])
        elif name == "alphaMode":
            value = "OPAQUE" if value is None else value
            if value not in _ALPHA_MODES:
                raise ArgumentError(f"a material's alphaMode: expected {', '.join(_ALPHA_MODES)}, got '{value}'")
        super().__setattr__(name, value)

    def __post_init__(self) -> None:
        self.emissiveFactor = color(self.emissiveFactor, 3, 0.0)
        self.alphaCutoff = 0.5 if self.alphaCutoff is None else float(self.alphaCutoff)

    def _color_and_numbers(self) -> tuple[NDArray[Any], float, float]:
        """Linear base colour with alpha, metallic, roughness."""
        return np.ones(4), 0.0, 1.0

    @property
    def is_transparent(self) -> bool:
        """Whether something of it is seen through."""
        if self.alphaMode == "OPAQUE":
            return False
        cutoff = 1.0 if self.alphaMode == "BLEND" else self.alphaCutoff
        texture = self._color_texture()
        return bool(self._color_and_numbers()[0][3] < cutoff) or (texture is not None and texture.is_transparent(cutoff))

    def put(self, material: "_easypbr.Material", is_flat: bool = False) -> None:
        """Sets EasyPBR's material to this one. `is_flat`: its colour is shown as it is, without light."""
        base, metallic, roughness = self._color_and_numbers()
        material.base_color = decoded(base[:3]) if is_flat else base[:3]
        material.metallic, material.roughness = metallic, roughness
        material.emissive = color(self.emissiveFactor, 3, 0.0)
        # pyrender sorts nothing that is opaque in fact.
        is_clear = base[3] < 1 and self.alphaMode != "OPAQUE"
        material.opacity = float(base[3]) if is_clear else 1.0
        is_blended = self.alphaMode == "BLEND" and self.is_transparent
        material.alpha_mode = "blend" if is_blended else {"OPAQUE": "opaque", "MASK": "mask"}.get(self.alphaMode, "auto")
        material.alpha_cutoff = self.alphaCutoff
        material.double_sided = self.doubleSided

    def put_textures(self, material: "_easypbr.Material") -> None:
        """Sets the images, which takes longer."""
        names = ("normal", "occlusion", "emissive", "base_color")
        for name, texture in zip(names, (self.normalTexture, self.occlusionTexture, self.emissiveTexture, self._color_texture())):
            if texture is not None and texture.pixels is not None:
                setattr(material, f"{name}_texture", texture.pixels)

    def _color_texture(self) -> Any:
        """The image of the base colour."""
        return None

    def textures(self) -> tuple[Any, ...]:
        """Its textures, or None for each that it does not have."""
        return self.normalTexture, self.occlusionTexture, self.emissiveTexture, self._color_texture()


@dataclass(eq=False, repr=False)
class MetallicRoughnessMaterial(Material):
    """glTF's metallic-roughness material; `baseColorFactor` is linear."""

    baseColorFactor: Any = None
    baseColorTexture: Any = None
    metallicFactor: float = 1.0
    roughnessFactor: float = 1.0
    metallicRoughnessTexture: Any = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self.baseColorFactor = color(self.baseColorFactor, 4, 1.0)
        self.metallicFactor = 1.0 if self.metallicFactor is None else float(self.metallicFactor)
        self.roughnessFactor = 1.0 if self.roughnessFactor is None else float(self.roughnessFactor)

    def _color_and_numbers(self) -> tuple[NDArray[Any], float, float]:
        return color(self.baseColorFactor, 4, 1.0), _fraction(self.metallicFactor), _fraction(self.roughnessFactor)

    def _color_texture(self) -> Any:
        return self.baseColorTexture

    def textures(self) -> tuple[Any, ...]:
        return (*super().textures(), self.metallicRoughnessTexture)

    def put_textures(self, material: "_easypbr.Material") -> None:
        super().put_textures(material)
        both = None if self.metallicRoughnessTexture is None else self.metallicRoughnessTexture.pixels
        if both is None:
            return
        if both.ndim == 2:
            both = both[:, :, None]
        # glTF: roughness in green, metallic in blue; the two alone, or one for both.
        roughness, metallic = {1: (0, 0), 2: (0, 1)}.get(both.shape[2], (1, 2))
        material.roughness_texture, material.metallic_texture = both[:, :, roughness].copy(), both[:, :, metallic].copy()


@dataclass(eq=False, repr=False)
class SpecularGlossinessMaterial(Material):
    """The older material of glTF: its diffuse colour, and roughness 1 - glossiness."""

    diffuseFactor: Any = None
    diffuseTexture: Any = None
    specularFactor: Any = None
    glossinessFactor: float = 1.0
    specularGlossinessTexture: Any = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self.diffuseFactor = color(self.diffuseFactor, 4, 1.0)
        self.specularFactor = color(self.specularFactor, 3, 1.0)
        self.glossinessFactor = float(self.glossinessFactor)

    def _color_and_numbers(self) -> tuple[NDArray[Any], float, float]:
        return color(self.diffuseFactor, 4, 1.0), 0.0, _fraction(1 - self.glossinessFactor)

    def _color_texture(self) -> Any:
        return self.diffuseTexture
