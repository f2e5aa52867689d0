// Renderer: runs the passes in order. Source order is pipeline order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/gl/readback.h"
#include "easypbr/render/effects/ambient_occlusion/ambient_occlusion_pass.h"
#include "easypbr/render/effects/bloom/bloom_pass.h"
#include "easypbr/render/effects/depth_of_field/focus_pass.h"
#include "easypbr/render/effects/ground/ground_pass.h"
#include "easypbr/render/lighting/background_pass.h"
#include "easypbr/render/lighting/lighting_pass.h"
#include "easypbr/render/output/display_pass.h"
#include "easypbr/render/output/output_pass.h"
#include "easypbr/render/pipeline/custom_pass.h"
#include "easypbr/render/pipeline/surface_frame.h"
#include "easypbr/render/primitives/lines/line_pass.h"
#include "easypbr/render/primitives/mesh/geometry_pass.h"
#include "easypbr/render/primitives/points/point_pass.h"
#include "easypbr/render/primitives/surfels/surfel_layers.h"
#include "easypbr/render/primitives/surfels/surfel_pass.h"
#include "easypbr/render/raster/software_geometry_pass.h"
#include "easypbr/render/raytrace/ray_pass.h"
#include "easypbr/render/shadow/shadow_maps.h"
#include "easypbr/render/transparency/transparency_pass.h"

namespace easypbr::render {

/// Pictures beside the final one, read from the frame drawn last: of a picture of one sample, through the
/// pixels' centres.
enum class Layer {
    albedo,             ///< RGBA f32, linear base colour, alpha 1 where there is geometry
    normal_world,       ///< RGB f32, unit world normal, 0 where there is nothing
    depth,              ///< one channel f32, distance along the optical axis, 0 where there is nothing
    roughness,          ///< one channel f32
    metallic,           ///< one channel f32
    occlusion,          ///< one channel f32, the material's
    ambient_occlusion,  ///< one channel f32, part of the surroundings that is seen; needs ssao.enabled
    object_id,  ///< one channel f32, 1 + place of the object in the snapshot, 0 where there is nothing; exact
    element_id  ///< one channel f32, 1 + index of the face or point in its object, 0 where there is nothing;
                ///< exact up to 2^24
};

/// "albedo", "normal_world", ... Throws NameError with the nearest name, or with what a former name became.
Layer layer_named(const std::string& name);
const std::vector<std::string>& layer_names();
/// What a layer is called now that was "normal", "id" or "element"; empty for other names.
std::string layer_formerly(const std::string& name);

struct DrawOptions {
    Vec2i size{800, 600};
    int samples = 1;
    Encoding encoding = Encoding::srgb8;
    Vec2i picture_size{0, 0};  ///< of a tile: of the whole picture that the camera sees; else 0
    Vec2i origin{0, 0};  ///< of a tile: its first pixel in the picture, multiples of tile_grid (tiles.h)
    double reach = unlimited_reach;  ///< of a tile: see Frame
    bool ids = false;                ///< fill the id target too
    bool layers = false;    ///< read_layer() will be called: blended surfaces stand in it where they are half
                            ///< opaque or more, and there is no picture
    bool surfaces = false;  ///< read_surfaces() and read_layer() will be called: where the picture's last
                            ///< frame does not hold what the pixels' centres see, that is drawn once more
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

    /// The same picture frame by frame: begin(), then add_sample() up to options.samples times; finish()
    /// writes the picture of the frames so far and may be called after any of them. After the last one it is
    /// draw()'s, bit for bit, and complete. What is drawn between must not be another picture: then begin()
    /// again.
    void begin(const SceneSnapshot& scene, const ResolvedSettings& resolved, const DrawOptions& options,
               const SettingsImages& images = {});
    /// Returns the number of frames so far.
    int add_sample();
    void finish();

    /// Draws nothing but surfaces, through the pixels' centres: for read_layer() and read_surfaces(). The
    /// picture that was drawn last stays; one that frames are added to has to begin again.
    void draw_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                       const SettingsImages& images = {});

    /// The picture as a texture, until another one is drawn; row 0 is the top.
    const gl::Texture& picture() const { return output_.texture(); }

    /// What read_layer() reads, until something else is drawn.
    const GBuffer& targets() const { return targets_; }

    /// RGBA, row 0 on top: u8, u16 or f32 by the encoding.
    Image read_picture() const;
    /// The first `width` x `height` pixels only: forces the picture to be finished.
    Image read_picture(int width, int height) const { return read_picture({0, 0, width, height}); }
    Image read_picture(const PixelRect& area) const;
    /// Begins to read the picture back, as it is now: an image of its size and kind, whose bytes
    /// readback.finish() fills.
    Image begin_reading(gl::Readback& readback) const;
    Image read_layer(Layer layer) const;
    /// What the pixels' centres see; of a picture drawn with `surfaces`.
    SurfaceFrame read_surfaces() const;

    /// Which pixel centres of a rectangle, inside the last picture or outside, some parts of objects would
    /// cover if they were alone: 1 or 0, row by row. `wanted` is asked with the object's place in the
    /// snapshot and the part's first face. The last picture was drawn with `surfaces`; what it left behind is
    /// not changed.
    std::vector<uint8_t> coverage(const PixelRect& area,
                                  const std::function<bool(size_t object, int first_face)>& wanted);

    /// Without a GPU, plain triangles are rasterised natively; false leaves them to the driver: for comparing
    /// the two.
    void allow_native_geometry(bool allow) {
        native_geometry_ = allow;
        shadow_maps_.allow_native(allow);
    }

    /// Passes of the program's own, each stage's in this order. They belong to pictures, not to layers.
    void set_passes(std::vector<CustomPass> passes) { custom_ = std::move(passes); }

    /// How often the shadow maps of a light have been drawn since the beginning: they are kept until the
    /// light or what casts changes.
    uint64_t shadow_maps_drawn() const { return shadow_maps_.drawn(); }

    /// From now on every pass is finished before the next begins, and timed.
    void measure_passes(bool measure) { measure_ = measure; }
    /// Milliseconds of each pass of the last picture, in pipeline order, summed over its frames.
    const std::vector<std::pair<std::string, double>>& pass_times() const { return pass_times_; }

  private:
    struct Picture;
    void prepare_targets(Vec2i size, const ResolvedSettings& resolved);
    void evict_unused();
    void draw_frame(Frame& frame, const DrawList& list, const DrawList& casters);
    /// Puts the objects where they are at the frame's time, 1 being the end.
    static void move_objects(DrawableScene& drawable, const SceneSnapshot& scene, const Motion& motion,
                             double time);
    /// Fills the G-buffer by the faster way that can draw these items.
    void draw_geometry(Frame& frame, const DrawList& list);
    void draw_geometry(Frame& frame, const DrawList& list, const GBuffer& targets);
    /// Draws the lines where there are no layers.
    void draw_lines(const Frame& frame, const DrawList& list);
    /// Draws the layered items over the picture, before and behind each other and the lines.
    void draw_transparent(Frame& frame, const DrawList& list);
    /// Draws layers, and the lines between them, before the surfaces of which `opaque` is the depth.
    void draw_layers(Frame& frame, const DrawList& layers, const std::vector<LineItem>& lines,
                     const gl::Texture& opaque);
    /// Depth that hides lines and layers: of what is drawn over everything else too.
    const gl::Texture& hiding_depth(const Frame& frame, const DrawList& list);
    /// The eye-dome lighting of the layers' points; nothing where there are none.
    const gl::Texture* shade_points(const Frame& frame, const DrawList& layers, const gl::Texture& opaque);
    /// Draws what must not be averaged or smoothed into the finished picture.
    void draw_exact(Frame& frame, const DrawList& list);
    /// Keeps what surfaces are drawn of in `drawn_`, and draws it.
    void keep_surfaces(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i size,
                       const SettingsImages& images);
    void draw_kept_surfaces();
    /// Lights a G-buffer, block by block of lights with their shadow maps.
    void draw_lights(Frame& frame, const GBuffer& targets);
    /// Whether rays are sent for this frame.
    bool traces(const Frame& frame) const;
    bool has_custom(Stage stage) const;
    void run_custom(Stage stage, const Frame& frame);
    /// What the lens and the eye make of the frame.
    LitPicture post_process(Frame& frame);
    const Box3d& bounds_of(const SceneSnapshot& scene);
    template <class Pass>
    void run(const char* name, Pass&& pass);
    const gl::Texture* background_texture(const Frame& frame, const SettingsImages& images);

    GBuffer targets_;
    gl::VertexArray no_attributes_;
    gpu::EnvironmentMaps environment_;
    gpu::MeshCache meshes_;
    gpu::TextureCache textures_;
    GeometryPass geometry_{meshes_, textures_};
    SpacingCache spacings_;
    DrawableCache drawables_{spacings_};
    gpu::ClosedMeshes closed_meshes_;
    SoftwareGeometryPass software_geometry_{spacings_, closed_meshes_};
    gpu::PointCache point_buffers_;
    gpu::SurfelCache surfel_buffers_;
    PointPass points_{spacings_, point_buffers_};
    SurfelSplats surfel_splats_{spacings_, surfel_buffers_};
    SurfelPass surfels_{surfel_splats_};
    SurfelLayers surfel_layers_{surfel_splats_};
    ShadowMaps shadow_maps_{meshes_, textures_, closed_meshes_, spacings_, point_buffers_, surfel_buffers_};
    AmbientOcclusionPass ambient_occlusion_;
    RayScene ray_scene_;
    RayPass rays_;
    LightingPass lighting_;
    GroundPass ground_;
    DisplayPass display_;
    LinePass lines_;
    TransparencyPass transparency_;
    BackgroundPass background_;
    FocusPass focus_;
    BloomPass bloom_;
    OutputPass output_;
    std::shared_ptr<const Image> background_image_;
    gl::Texture background_texture_;
    GBuffer over_;  ///< what is drawn over everything else
    gl::Texture hiding_depth_;
    gl::Framebuffer hiding_;
    ProgramVariants hiding_programs_{"screen_triangle.vert", "opaque_limit.frag"};
    SurfaceComposite composite_;
    std::vector<CustomPass> custom_;
    gl::Texture custom_copies_[3];  ///< by stage, see PassInput::before()
    Camera camera_;
    std::vector<ElementSources> element_sources_;  ///< DrawableScene::sources of the last picture
    /// Of the last picture that was drawn with `surfaces`.
    struct Drawn {
        DrawableScene drawable;
        ResolvedSettings resolved;
        SceneSnapshot scene;
        DrawList surfaces;  ///< its items point into `drawable`
        Vec2i size{0, 0};
    };
    std::unique_ptr<Drawn> drawn_;
    GBuffer coverage_targets_;
    /// Bounds of the last scene, and what they were computed from.
    std::vector<std::pair<uint64_t, Eigen::Affine3d>> bounded_;
    Box3d bounds_;
    std::unique_ptr<Picture> picture_;  ///< that frames are added to
    bool native_geometry_ = true;
    bool measure_ = false, running_ = false;
    std::vector<std::pair<std::string, double>> pass_times_;
};

}  // namespace easypbr::render
