"""The metallic-roughness material of glTF 2.0 (Appendix B) as a BSDF of Mitsuba 3, as the renderers that are compared have it.

Mitsuba's variant must be set before this is imported. As a program it prints the part of an even light that squares reflect, as
Mitsuba finds it and by a sum over the hemisphere, of the formulas written once more.
"""
import drjit as dr
import mitsuba as mi
import numpy as np

if __name__ == "__main__":
    mi.set_variant("llvm_ad_rgb")

F0 = 0.04  # of dielectrics of index 1.5


class GltfBsdf(mi.BSDF):
    """base_color: linear; metallic: 0 to 1; roughness: 0 to 1, its square is alpha of GGX. One-sided."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.base_color = mi.Color3f(props["base_color"])
        self.metallic = float(props["metallic"])
        self.alpha = float(props["roughness"]) ** 2
        self.m_components = [mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide,
                             mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def normals(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha)

    def of_specular(self):
        """Part of the samples: what is diffuse has half of them."""
        return 0.5 + 0.5 * self.metallic

    def value(self, wi, wo):
        """f(wi, wo) cos(wo)."""
        m = dr.normalize(wi + wo)
        i, o = mi.Frame3f.cos_theta(wi), mi.Frame3f.cos_theta(wo)
        schlick = (1 - dr.clip(dr.dot(wi, m), 0, 1)) ** 5
        # Smith's visibility for both directions at once.
        a2 = self.alpha**2
        visible = 0.5 / (o * dr.sqrt(i * i * (1 - a2) + a2) + i * dr.sqrt(o * o * (1 - a2) + a2))
        specular = self.normals().eval(m) * visible
        metal = specular * (self.base_color + (1 - self.base_color) * schlick)
        fresnel = F0 + (1 - F0) * schlick
        dielectric = self.base_color * (dr.inv_pi * (1 - fresnel)) + specular * fresnel
        return (dielectric * (1 - self.metallic) + metal * self.metallic) * o

    def density(self, wi, wo):
        m = dr.normalize(wi + wo)
        reflected = self.normals().pdf(wi, m) / (4 * dr.dot(wo, m))
        return dr.lerp(mi.warp.square_to_cosine_hemisphere_pdf(wo), reflected, self.of_specular())

    def sees(self, wi, wo, active):
        return active & (mi.Frame3f.cos_theta(wi) > 0) & (mi.Frame3f.cos_theta(wo) > 0)

    def sample(self, ctx, si, sample1, sample2, active=True):
        specular = sample1 < self.of_specular()
        m, _ = self.normals().sample(si.wi, sample2)
        bs = mi.BSDFSample3f()
        bs.wo = dr.select(specular, mi.reflect(si.wi, m), mi.warp.square_to_cosine_hemisphere(sample2))
        seen = self.sees(si.wi, bs.wo, active)
        bs.pdf = dr.select(seen, self.density(si.wi, bs.wo), 0)
        seen &= bs.pdf > 0
        bs.eta = 1.0
        bs.sampled_type = dr.select(specular, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection))
        bs.sampled_component = dr.select(specular, mi.UInt32(0), mi.UInt32(1))
        return bs, dr.select(seen, self.value(si.wi, bs.wo) / bs.pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        return dr.select(self.sees(si.wi, wo, active), self.value(si.wi, wo), 0)

    def pdf(self, ctx, si, wo, active=True):
        return dr.select(self.sees(si.wi, wo, active), self.density(si.wi, wo), 0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return f"GltfBsdf[metallic={self.metallic}, alpha={self.alpha}]"


def rendered_albedo(color, metallic, roughness, angle):
    eye = [0, 10 * np.sin(angle), 10 * np.cos(angle)]
    to_world = mi.ScalarTransform4f().look_at(origin=eye, target=[0, 0, 0], up=[0, 1, 0.01])
    bsdf = {"type": "gltf", "base_color": {"type": "rgb", "value": [color] * 3}, "metallic": metallic, "roughness": roughness}
    film = {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}}
    scene = mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": 2}, "light": {"type": "constant"},
                          "sensor": {"type": "perspective", "fov": 1, "to_world": to_world, "film": film},
                          "square": {"type": "rectangle", "bsdf": bsdf}})
    return np.array(mi.render(scene, spp=4096))[..., :3].mean()


def summed_albedo(color, metallic, roughness, angle, steps=1000):
    z, phi = np.meshgrid((np.arange(steps) + 0.5) / steps, (np.arange(steps) + 0.5) / steps * 2 * np.pi)
    out = np.stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z], -1)
    eye = np.array([np.sin(angle), 0, np.cos(angle)])
    half = (out + eye) / np.linalg.norm(out + eye, axis=-1, keepdims=True)
    a2, i = roughness**4, eye[2]
    lobe = a2 / np.pi / (half[..., 2] ** 2 * (a2 - 1) + 1) ** 2 * 0.5
    lobe /= z * np.sqrt(i * i * (1 - a2) + a2) + i * np.sqrt(z * z * (1 - a2) + a2)
    grazing = (1 - half @ eye) ** 5
    fresnel = 0.04 + 0.96 * grazing
    f = lobe * (color + (1 - color) * grazing) if metallic else color / np.pi * (1 - fresnel) + lobe * fresnel
    return (f * z).mean() * 2 * np.pi


def main():
    mi.register_bsdf("gltf", GltfBsdf)
    for case in ((0.5, 1.0, 0.2, 0.3), (0.5, 1.0, 0.5, 1.0), (0.5, 0.0, 0.3, 0.3), (0.5, 0.0, 0.3, 1.2), (0.5, 0.0, 0.6, 0.8)):
        print("colour {}, metallic {}, roughness {}, angle {}:".format(*case), f"{rendered_albedo(*case):.4f}, {summed_albedo(*case):.4f}")


if __name__ == "__main__":
    main()
