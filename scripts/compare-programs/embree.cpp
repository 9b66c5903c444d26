// A ray tracer on Intel's Embree, for comparison: the image model, one ray at a time.
//
// Spheres and triangles are Embree's. It has no suitable shape for planes and cylinders, which are
// tested in a separate list. Single precision. It reads the text that scene_to_text.py writes;
// README.md says how to run it.

#include <embree3/rtcore.h>
#include <omp.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// ---------------------------------------------------------------- vectors

struct Vec3 {
    float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(Vec3 a) { return (1 / length(a)) * a; }
inline float largest(Vec3 a) { return std::max(std::max(std::fabs(a.x), std::fabs(a.y)), std::fabs(a.z)); }

// `shininess` is a whole number from 1 on.
inline float power(float base, int exponent) {
    float result = 1;
    for (; exponent > 0; exponent >>= 1, base *= base)
        if (exponent & 1) result *= base;
    return result;
}

// ---------------------------------------------------------------- scene

constexpr float miss = std::numeric_limits<float>::infinity();

struct Material {
    Vec3 color;
    float ambient, diffuse, specular;
    int shininess;
    float reflection;
};

struct Light {
    Vec3 position, color;  // the colour times the power
};

struct Camera {
    Vec3 position, forward, right, up;  // an orthonormal frame
    float focal_length, screen_width;
};

struct Plane {
    Vec3 point, normal;
    unsigned material;

    float intersect(Vec3 origin, Vec3 direction) const {
        const float slope = dot(direction, normal);
        if (slope == 0) return miss;
        const float t = dot(point - origin, normal) / slope;
        return t > 0 ? t : miss;
    }
};

struct Cylinder {
    Vec3 bottom;
    float top, radius;
    unsigned material;

    float intersect(Vec3 origin, Vec3 d) const {
        const float a = d.x * d.x + d.z * d.z;
        if (a == 0) return miss;
        // From the ray's point closest to the axis, in x and z: no cancellation far away.
        const float px = bottom.x - origin.x, pz = bottom.z - origin.z;
        const float middle = (px * d.x + pz * d.z) / a;
        const float fx = px - middle * d.x, fz = pz - middle * d.z;
        const float left = radius * radius - (fx * fx + fz * fz);
        if (left < 0) return miss;
        const float half = std::sqrt(left / a);
        const auto on_wall = [&](float t) {
            const float y = origin.y + t * d.y;
            return t > 0 && bottom.y <= y && y <= top;
        };
        if (on_wall(middle - half)) return middle - half;
        return on_wall(middle + half) ? middle + half : miss;
    }
};

struct Sphere {  // Embree's layout
    Vec3 center;
    float radius;
};

struct Scene {
    int width = 0, height = 0, antialiasing = 0, max_reflections = 0;
    Vec3 background;
    Camera camera{};
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<Plane> planes;
    std::vector<Cylinder> cylinders;
    std::vector<Sphere> spheres;
    std::vector<Vec3> corners;  // three a triangle
    std::vector<unsigned> sphere_materials, triangle_materials;
};

class Reader {
public:
    explicit Reader(const std::string& text) : at_(text.data()), end_(text.data() + text.size()) {}

    template <typename T>
    T value() {
        skip();
        T v;
        const auto [next, error] = std::from_chars(at_, end_, v);
        if (error != std::errc()) throw std::runtime_error("scene: a number is missing or malformed");
        at_ = next;
        return v;
    }
    float number() { return float(value<double>()); }
    Vec3 vec3() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    void word(std::string_view expected) {
        skip();
        const char* begin = at_;
        while (at_ != end_ && static_cast<unsigned char>(*at_) > ' ') ++at_;
        if (std::string_view(begin, at_ - begin) != expected)
            throw std::runtime_error("scene: expected '" + std::string(expected) + "'");
    }
    std::size_t count(const char* keyword) {
        word(keyword);
        return value<std::size_t>();
    }

private:
    void skip() {
        while (at_ != end_ && static_cast<unsigned char>(*at_) <= ' ') ++at_;
    }
    const char *at_, *end_;
};

Scene read_scene(const std::string& text) {
    Reader r(text);
    Scene s;
    r.word("image");
    s.width = r.value<int>();
    s.height = r.value<int>();
    r.word("camera");
    const Vec3 position = r.vec3(), look_at = r.vec3(), up = r.vec3();
    s.camera.position = position;
    s.camera.forward = unit(look_at - position);
    s.camera.right = unit(cross(s.camera.forward, up));
    s.camera.up = cross(s.camera.right, s.camera.forward);
    s.camera.focal_length = r.number();
    s.camera.screen_width = r.number();
    r.word("render");
    s.background = r.vec3();
    s.max_reflections = r.value<int>();
    s.antialiasing = r.value<int>();
    for (std::size_t n = r.count("lights"); n > 0; --n) {
        const Vec3 at = r.vec3(), color = r.vec3();
        s.lights.push_back({at, r.number() * color});
    }
    for (std::size_t n = r.count("materials"); n > 0; --n) {
        Material m;
        m.color = r.vec3();
        m.ambient = r.number();
        m.diffuse = r.number();
        m.specular = r.number();
        m.shininess = r.value<int>();
        m.reflection = r.number();
        s.materials.push_back(m);
    }
    const auto material = [&] {
        const auto i = r.value<unsigned>();
        if (i >= s.materials.size()) throw std::runtime_error("scene: no such material");
        return i;
    };
    for (std::size_t n = r.count("planes"); n > 0; --n) {
        const Vec3 point = r.vec3(), normal = r.vec3();
        s.planes.push_back({point, unit(normal), material()});
    }
    for (std::size_t n = r.count("spheres"); n > 0; --n) {
        const Vec3 center = r.vec3();
        s.spheres.push_back({center, r.number()});
        s.sphere_materials.push_back(material());
    }
    for (std::size_t n = r.count("triangles"); n > 0; --n) {
        for (int k = 0; k < 3; ++k) s.corners.push_back(r.vec3());
        s.triangle_materials.push_back(material());
    }
    for (std::size_t n = r.count("cylinders"); n > 0; --n) {
        const Vec3 bottom = r.vec3();
        const float top = r.number(), radius = r.number();
        s.cylinders.push_back({bottom, top, radius, material()});
    }
    return s;
}

// ---------------------------------------------------------------- Embree's part

class Accelerator {
public:
    static constexpr unsigned spheres = 0, triangles = 1;  // the geometries' numbers

    Accelerator(const Scene& scene, int threads, bool robust) {
        device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
        if (!device_) throw std::runtime_error("Embree cannot create a device");
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        if (const std::size_t n = scene.spheres.size()) {
            const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
            std::copy(scene.spheres.begin(), scene.spheres.end(),
                      buffer<Sphere>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, n));
            attach(g, spheres);
        }
        if (const std::size_t n = scene.triangle_materials.size()) {
            const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
            std::copy(scene.corners.begin(), scene.corners.end(),
                      buffer<Vec3>(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * n));
            unsigned* index = buffer<unsigned>(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, n);
            for (std::size_t i = 0; i < 3 * n; ++i) index[i] = unsigned(i);
            attach(g, triangles);
        }
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree rejects the scene");
        empty_ = scene.spheres.empty() && scene.triangle_materials.empty();
    }
    ~Accelerator() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Accelerator(const Accelerator&) = delete;
    Accelerator& operator=(const Accelerator&) = delete;

    RTCScene scene() const { return scene_; }
    bool empty() const { return empty_; }
    std::string version() const {
        const auto part = [&](RTCDeviceProperty p) { return std::to_string(rtcGetDeviceProperty(device_, p)); };
        return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
               part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
    }

private:
    template <typename T>
    static T* buffer(RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t n) {
        const std::size_t stride = type == RTC_BUFFER_TYPE_INDEX ? 3 * sizeof(unsigned) : sizeof(T);
        void* data = rtcSetNewGeometryBuffer(g, type, 0, format, stride, n);
        if (!data) throw std::runtime_error("Embree cannot allocate a buffer");
        return static_cast<T*>(data);
    }
    void attach(RTCGeometry g, unsigned id) {
        rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_HIGH);
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(scene_, g, id);
        rtcReleaseGeometry(g);
    }
    RTCDevice device_;
    RTCScene scene_;
    bool empty_;
};

// ---------------------------------------------------------------- tracing

struct Sample {
    float dx, dy, weight;
};

std::vector<Sample> sample_grid(int s) {
    if (s == 0) return {{0, 0, 1}};
    std::vector<Sample> grid;
    double sum = 0;
    const auto weight = [s](int i, int j) { return std::exp(-double(i * i + j * j) / (s * s) / 0.64); };
    for (int j = -s; j <= s; ++j)
        for (int i = -s; i <= s; ++i) sum += weight(i, j);
    for (int j = -s; j <= s; ++j)
        for (int i = -s; i <= s; ++i)
            grid.push_back({float(i) / float(s), float(j) / float(s), float(weight(i, j) / sum)});
    return grid;
}

class Tracer {
public:
    Tracer(const Scene& scene, const Accelerator& accelerator)
        : scene_(scene), rtc_(accelerator.scene()), empty_(accelerator.empty()),
          grid_(sample_grid(scene.antialiasing)), axis_(scene.camera.focal_length * scene.camera.forward),
          pixel_(scene.camera.screen_width / float(scene.width)) {
        rtcInitIntersectContext(&coherent_);
        coherent_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcInitIntersectContext(&incoherent_);
    }

    Vec3 pixel(int i, int j) {
        Vec3 color;
        for (const Sample& s : grid_) {
            const float x = float(i) + 0.5f + s.dx - float(scene_.width) / 2;
            const float y = float(scene_.height) / 2 - (float(j) + 0.5f + s.dy);
            const Vec3 direction = axis_ + pixel_ * x * scene_.camera.right + pixel_ * y * scene_.camera.up;
            color = color + s.weight * trace(scene_.camera.position, unit(direction), 0);
        }
        return color;
    }

private:
    Vec3 trace(Vec3 origin, Vec3 direction, int bounce) {
        // The shapes that are not Embree's first: Embree's ray ends at their closest hit.
        float nearest = miss;
        const Plane* plane = nullptr;
        const Cylinder* cylinder = nullptr;
        for (const Plane& p : scene_.planes)
            if (const float t = p.intersect(origin, direction); t < nearest) nearest = t, plane = &p;
        for (const Cylinder& c : scene_.cylinders)
            if (const float t = c.intersect(origin, direction); t < nearest) nearest = t, cylinder = &c, plane = nullptr;

        RTCRayHit ray;
        set(ray.ray, origin, direction, nearest);
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (!empty_) rtcIntersect1(rtc_, bounce == 0 ? &coherent_ : &incoherent_, &ray);

        Vec3 point = origin + ray.ray.tfar * direction, normal;
        const Material* material;
        if (ray.hit.geomID == Accelerator::spheres) {
            // Snap to the sphere: the error of the distance grows with the distance.
            const Sphere& s = scene_.spheres[ray.hit.primID];
            normal = unit(point - s.center);
            point = s.center + s.radius * normal;
            material = &scene_.materials[scene_.sphere_materials[ray.hit.primID]];
        } else if (ray.hit.geomID == Accelerator::triangles) {
            normal = unit({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z});
            material = &scene_.materials[scene_.triangle_materials[ray.hit.primID]];
        } else if (plane) {
            normal = plane->normal;
            material = &scene_.materials[plane->material];
        } else if (cylinder) {
            normal = unit({point.x - cylinder->bottom.x, 0, point.z - cylinder->bottom.z});
            point = {cylinder->bottom.x + cylinder->radius * normal.x, point.y,
                     cylinder->bottom.z + cylinder->radius * normal.z};
            material = &scene_.materials[cylinder->material];
        } else {
            return scene_.background;
        }
        if (dot(normal, direction) > 0) normal = -normal;
        // The next rays start on this ray's side of the surface, several ulps of the coordinates
        // away from it.
        const float lift = 0x1p-19f * std::max(largest(point), largest(origin));
        const Vec3 start = point + lift * normal;

        const Vec3 color = surface(*material, point, start, normal, direction);
        const float k = material->reflection;
        if (!(k > 0)) return color;
        if (bounce == scene_.max_reflections) return (1 - k) * color;
        const Vec3 mirrored = direction - 2 * dot(normal, direction) * normal;
        return (1 - k) * color + k * trace(start, mirrored, bounce + 1);
    }

    Vec3 surface(const Material& material, Vec3 point, Vec3 start, Vec3 normal, Vec3 direction) {
        Vec3 color = material.ambient * material.color;
        for (const Light& light : scene_.lights) {
            const Vec3 way = light.position - point;
            const float distance = length(way);
            if (distance == 0) continue;
            const Vec3 l = (1 / distance) * way;
            const float facing = dot(normal, l);
            if (facing <= 0 || in_shadow(start, l, distance)) continue;
            const float highlight = dot(2 * facing * normal - l, -direction);
            Vec3 lit = material.diffuse * facing * material.color;
            if (highlight > 0) {
                const float s = material.specular * power(highlight, material.shininess);
                lit = lit + Vec3{s, s, s};
            }
            color = color + lit * light.color;
        }
        return color;
    }

    bool in_shadow(Vec3 start, Vec3 l, float distance) {
        const float end = distance * (1 - 0x1p-18f);
        for (const Plane& p : scene_.planes)
            if (p.intersect(start, l) < end) return true;
        for (const Cylinder& c : scene_.cylinders)
            if (c.intersect(start, l) < end) return true;
        if (empty_) return false;
        RTCRay ray;
        set(ray, start, l, end);
        rtcOccluded1(rtc_, &coherent_, &ray);
        return ray.tfar < 0;
    }

    static void set(RTCRay& ray, Vec3 origin, Vec3 direction, float end) {
        ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z, ray.tnear = 0;
        ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z, ray.time = 0;
        ray.tfar = end, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
    }

    const Scene& scene_;
    const RTCScene rtc_;
    const bool empty_;
    const std::vector<Sample> grid_;
    const Vec3 axis_;
    const float pixel_;
    RTCIntersectContext coherent_, incoherent_;
};

// ---------------------------------------------------------------- the image

using Image = std::vector<Vec3>;  // row by row, the top one first

void no_denormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

// Dynamic scheduling of tiles.
void render(const Scene& scene, const Accelerator& accelerator, int threads, Image& image) {
    constexpr int side = 16;
    const int across = (scene.width + side - 1) / side, down = (scene.height + side - 1) / side;
#pragma omp parallel num_threads(threads)
    {
        no_denormals();
        Tracer tracer(scene, accelerator);
#pragma omp for schedule(dynamic, 1)
        for (int tile = 0; tile < across * down; ++tile) {
            const int left = tile % across * side, top = tile / across * side;
            for (int j = top; j < std::min(top + side, scene.height); ++j)
                for (int i = left; i < std::min(left + side, scene.width); ++i)
                    image[std::size_t(j) * scene.width + i] = tracer.pixel(i, j);
        }
    }
}

void write_image(const std::string& path, const Image& image, int width, int height) {
    std::string data = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
    for (const Vec3& c : image)
        for (const float v : {c.x, c.y, c.z})
            data.push_back(char(int(255 * std::min(std::max(v, 0.0f), 1.0f) + 0.5f)));
    std::ofstream out(path, std::ios::binary);
    if (!out.write(data.data(), std::streamsize(data.size())).flush())
        throw std::runtime_error("cannot write " + path);
}

// ---------------------------------------------------------------- the command

constexpr const char* usage =
    "usage: embree SCENE.txt [options]          (SCENE.txt as scene_to_text.py writes it)\n"
    "  --threads N             threads, default 1\n"
    "  --size WxH              pixels, instead of the scene's\n"
    "  --antialiasing N        lattice density, 0..32, instead of the scene's\n"
    "  --repeat R              timed runs, default 1\n"
    "  --no-robust             Embree's scene without RTC_SCENE_FLAG_ROBUST\n"
    "  -o FILE                 the image, a PPM\n";

int integer(const std::string& text, int low, int high, const char* what) {
    char* end = nullptr;
    const long v = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || v < low || v > high)
        throw std::runtime_error(std::string(what) + ": expected an integer from " + std::to_string(low) + " to " +
                                 std::to_string(high) + ", got '" + text + "'");
    return int(v);
}

double since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int run(int argc, char** argv) {
    std::string path, output, size, antialiasing;
    int threads = 1, repeat = 1;
    bool robust = true;
    for (int a = 1; a < argc; ++a) {
        const std::string arg = argv[a];
        const auto next = [&]() -> std::string {
            if (a + 1 >= argc) throw std::runtime_error(arg + " needs a value");
            return argv[++a];
        };
        if (arg == "--threads") threads = integer(next(), 1, 1024, "--threads");
        else if (arg == "--size") size = next();
        else if (arg == "--antialiasing") antialiasing = next();
        else if (arg == "--repeat") repeat = integer(next(), 1, 1000000, "--repeat");
        else if (arg == "--no-robust") robust = false;
        else if (arg == "-o") output = next();
        else if (arg == "-h" || arg == "--help") return std::fputs(usage, stdout), 0;
        else if (path.empty() && arg[0] != '-') path = arg;
        else throw std::runtime_error("unexpected argument '" + arg + "'");
    }
    if (path.empty()) throw std::runtime_error(std::string("no scene given\n") + usage);

    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::string text(std::istreambuf_iterator<char>(file), {});
    Scene scene = read_scene(text);
    text = {};
    if (!size.empty()) {
        const auto by = size.find('x');
        scene.width = integer(size.substr(0, by), 1, 65535, "--size");
        scene.height = integer(by == std::string::npos ? "" : size.substr(by + 1), 1, 65535, "--size");
    }
    if (!antialiasing.empty()) scene.antialiasing = integer(antialiasing, 0, 32, "--antialiasing");

    no_denormals();
    auto start = std::chrono::steady_clock::now();
    const Accelerator accelerator(scene, threads, robust);
    const double build = since(start);

    Image image(std::size_t(scene.width) * scene.height);
    for (int r = 0; r < repeat; ++r) {
        start = std::chrono::steady_clock::now();
        render(scene, accelerator, threads, image);
        const double seconds = since(start);
        std::printf("{\"repeat\":%d,\"seconds\":%.6f,\"build_seconds\":%.6f,\"width\":%d,\"height\":%d,"
                    "\"antialiasing\":%d,\"threads\":%d,\"robust\":%s,\"embree\":\"%s\"}\n",
                    r, seconds, build, scene.width, scene.height, scene.antialiasing, threads,
                    robust ? "true" : "false", accelerator.version().c_str());
        std::fflush(stdout);
    }
    if (!output.empty()) write_image(output, image, scene.width, scene.height);
    return 0;
}

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "embree: %s\n", e.what());
        return 1;
    }
}
