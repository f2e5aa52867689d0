"""A Mitsuba integrator for what image-based lighting by split sum approximates: every visible point sees the whole
environment, whatever else of the scene is in the way. On a convex shape it agrees with Mitsuba's `direct`."""
import drjit as dr
import mitsuba as mi


class Unoccluded(mi.SamplingIntegrator):
    """Direct light of the environment without shadows, by multiple importance sampling (balance heuristic)."""

    def sample(self, scene, sampler, ray, medium=None, active=True):
        si = scene.ray_intersect(ray, active)
        hit = active & si.is_valid()
        radiance = self.by_emitter(scene, sampler, si, hit) + self.by_bsdf(scene, sampler, si, hit)
        return dr.select(hit, radiance, 0), hit, []

    def by_emitter(self, scene, sampler, si, hit):
        ds, weight = scene.sample_emitter_direction(si, sampler.next_2d(hit), False, hit)
        value, pdf = si.bsdf().eval_pdf(mi.BSDFContext(), si, si.to_local(ds.d), hit)
        return dr.select(ds.pdf > 0, value * weight * ds.pdf / (ds.pdf + pdf), 0)

    def by_bsdf(self, scene, sampler, si, hit):
        bs, weight = si.bsdf().sample(mi.BSDFContext(), si, sampler.next_1d(hit), sampler.next_2d(hit), hit)
        direction = si.to_world(bs.wo)
        away = dr.zeros(mi.SurfaceInteraction3f)
        away.wi = -direction
        ds = dr.zeros(mi.DirectionSample3f)
        ds.d = direction
        pdf = scene.environment().pdf_direction(si, ds, hit)
        return dr.select(bs.pdf > 0, weight * scene.environment().eval(away, hit) * bs.pdf / (bs.pdf + pdf), 0)


mi.register_integrator("unoccluded", lambda properties: Unoccluded(properties))
