// Renderer: runs the passes in order. Source order is pipeline order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/gl/readback.h"
#include "easypbr/render/output/background_image.h"
#include "easypbr/render/pipeline/layers.h"
#include "easypbr/render/pipeline/pipeline.h"
#include "easypbr/render/pipeline/surface_frame.h"

namespace easypbr::render {

class KeptSurfaces;

struct DrawOptions {
    Vec2i size{800, 600};
    int samples = 1;
    Encoding encoding = Encoding::srgb8;
    Vec2i picture_size{0, 0};  ///< of a tile: of the whole picture that the camera sees; else 0
    Vec2i origin{0, 0};  ///< of a tile: its first pixel in the picture, multiples of tile_grid (tiles.h)
    double reach = unlimited_reach;  ///< of a tile: see Frame
    double time_share = 1;           ///< of a tile: its part of image.time_budget
    bool ids = false;                ///< fill the id target too
    bool layers = false;  ///< of draw(): read_layer() will be called: blended surfaces stand in it where they
                          ///< are half opaque or more, of discs that overlap the nearest; there is no
                          ///< picture
    bool occlusion = false;  ///< with `layers`: Layer::ambient_occlusion, too
    bool surfaces = false;   ///< read_surfaces() and read_layer() will be called: where the picture's last
                             ///< frame does not hold what the pixels' centres see, that is drawn once more;
                             ///< with `layers` they hold it, of a tile too
    bool without_image = false;  ///< alpha is below 1 where a background image would be seen: whoever reads
                                 ///< the picture puts that behind it
    bool exact_pixels = false;   ///< exact_pixels() will be called
    std::shared_ptr<const Motion> motion = {};  ///< since the picture before: blurs what moved, in several
                                                ///< samples
};

/// Images that the settings name, loaded by the caller.
struct SettingsImages {
    Material textures;                        ///< texture and shader overrides
    ShaderFiles shader_files = {};            ///< of the materials' shaders
    std::shared_ptr<const Image> background;  ///< for background mode image
};

/// All members need the context current. Throws ContextError when a size is beyond the driver's limit.
class Renderer {
  public:
    Renderer();
    ~Renderer();

    /// Draws a picture; read_picture() and read_layer() give what was drawn last.
    void draw(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
              const SettingsImages& images = {});

    /// The same picture frame by frame: begin(), then add_sample() until is_complete(), which is after
    /// options.samples frames at the latest; finish() writes the picture of the frames so far and may be
    /// called after any of them. After the last one it is draw()'s, bit for bit (but for image.time_budget).
    /// What is drawn between must not be another picture: then begin() again.
    void begin(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
               const SettingsImages& images = {});
    /// Returns the number of frames so far.
    int add_sample();
    /// Whether the picture has all its frames, is as good as image.noise asks, or has taken
    /// image.time_budget.
    bool is_complete() const;
    void finish();

    /// Draws nothing but surfaces, through the pixels' centres: for read_layer() and read_surfaces(). The
    /// picture that was drawn last stays; one that frames are added to has to begin again.
    void draw_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                       const SettingsImages& images = {});

    /// The picture as a texture, until another one is drawn; row 0 is the top.
    const gl::Texture& picture() const { return output_.texture(); }

    /// What read_layer() reads, until something else is drawn.
    const GBuffer& targets() const { return pipeline_.targets(); }

    /// The same, all of it in textures. With the context current.
    const GBuffer& uploaded_targets() {
        pipeline_.targets().upload(pipeline_.transfers());
        return pipeline_.targets();
    }

    /// Whether the picture is in host memory alone: read_picture() needs no driver.
    bool has_picture_in_memory() const { return output_.is_finished_natively(); }
    /// RGBA, row 0 on top: u8, u16 or f32 by the encoding.
    Image read_picture() const;
    /// The first `width` x `height` pixels only: forces the picture to be finished.
    Image read_picture(int width, int height) const { return read_picture({0, 0, width, height}); }
    Image read_picture(const PixelRect& area) const;
    /// Where the picture, drawn with `exact_pixels`, shows colours of tables that nothing may mix with:
    /// u8, one channel, 255 there, else 0. Empty where nothing has such colours.
    const Image& exact_pixels() const { return exact_pixels_; }
    /// Begins to read the picture back, as it is now: an image of its size and kind, whose bytes
    /// readback.finish() fills. Nothing is pending of a picture in host memory, which the image is at once.
    Image begin_reading(gl::Readback& readback) const;
    /// Throws ArgumentError for a path traced picture that was drawn without `surfaces`: the memory went to
    /// its denoiser.
    Image read_layer(Layer layer) const;
    /// What the pixels' centres see; of a picture drawn with `surfaces`.
    SurfaceFrame read_surfaces() const;

    /// Which pixel centres of a rectangle, inside the last picture or outside, some parts of objects would
    /// cover if they were alone: 1 or 0, row by row. Blended ones count whatever their opacity. `wanted` is
    /// asked with the object's place in the snapshot and the part's first face. The last picture was drawn
    /// with `surfaces`; what it left behind is not changed.
    std::vector<uint8_t> coverage(const PixelRect& area,
                                  const std::function<bool(size_t object, int first_face)>& wanted);

    /// How far beyond its vertices each object of the snapshot may reach in the last picture, which was drawn
    /// with `surfaces`; of voxels beyond the cells of its vertices.
    std::vector<ScreenReach> reaches();

    /// Which objects of the snapshot have a blended surface: pixels that cover it may see what is behind.
    const std::vector<bool>& blended() const;

    /// Without a GPU, plain triangles are rasterised natively; false leaves them to the driver: for comparing
    /// the two.
    void allow_native_geometry(bool allow) { pipeline_.allow_native_geometry(allow); }
    void allow_native_shading(bool allow) { pipeline_.allow_native_shading(allow); }

    /// Passes of the program's own, each stage's in this order. They belong to pictures, not to layers.
    void set_passes(std::vector<CustomPass> passes) { custom_.set(std::move(passes)); }

    /// How often the shadow maps of a light have been drawn since the beginning: they are kept until the
    /// light or what casts changes.
    uint64_t shadow_maps_drawn() const { return pipeline_.shadow_maps().drawn(); }

    /// Copies of targets between host memory and textures since the last picture began; reading it is not
    /// counted.
    const Transfers& transfers() const { return pipeline_.transfers(); }

    /// From now on every pass is finished before the next begins, and timed.
    void measure_passes(bool measure) { pipeline_.timer().enable(measure); }
    /// Milliseconds of each pass of the last picture, in pipeline order, summed over its frames.
    const std::vector<std::pair<std::string, double>>& pass_times() const {
        return pipeline_.timer().times();
    }

  private:
    struct Picture;
    /// Surfaces through the pixels' centres, without a picture.
    void draw_layers(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
                     const SettingsImages& images);
    void prepare(Picture& picture);
    void draw_sample(Picture& picture);
    /// The layers of a path traced frame, over exact colours: those are seen through the pixels' centres.
    void draw_layers_before_exact(Picture& picture);
    /// A frame of `list` that follows those that the picture has.
    Frame next_frame(const Picture& picture, const Shot& shot, Camera camera, const DrawList& list);
    /// All of the last frame's light is in the mean.
    void release_radiance();
    void keep_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                       const SettingsImages& images);
    void draw_kept();
    /// All that the last frame tells is in its picture.
    void release_targets();
    /// Draws the exact colours that nothing may mix with, once, through the pixels' centres.
    /// `shown`: what the picture was finished from.
    void draw_exact(const LitPicture& shown);
    void draw_custom_over_picture();
    /// Null where there is none.
    BackgroundImage* background_image(const ResolvedSettings& resolved, const SettingsImages& images);
    void evict_unused();

    Pipeline pipeline_;
    DrawableCache drawables_{pipeline_.caches().spacings};
    CustomPasses custom_;
    OutputPass output_{pipeline_.transfers()};
    Image exact_pixels_;                           ///< of the last picture
    bool has_layers_ = false;                      ///< the targets hold what read_layer() reads
    std::unique_ptr<KeptSurfaces> kept_;           ///< of a picture that was drawn with `surfaces`
    Camera camera_;                                ///< that the targets were seen by
    std::vector<ElementSources> sources_;          ///< of what the targets hold
    std::unique_ptr<BackgroundImage> background_;  ///< the last one that was shown
    std::unique_ptr<Picture> picture_;             ///< that frames are added to
};

}  // namespace easypbr::render
