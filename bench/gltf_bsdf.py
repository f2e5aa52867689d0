"""The metallic-roughness material of glTF 2.0 (Appendix B) as a BSDF of Mitsuba 3, as the renderers that are compared have it.

Mitsuba's variant must be set before this is imported.
"""
import drjit as dr
import mitsuba as mi

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
