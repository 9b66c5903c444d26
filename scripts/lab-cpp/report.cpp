// A ray tracer as a student's lab report describes one, to compare rayweave with: an array of
// pointers to primitives, a virtual `intersect`, single precision, every ray tested against every
// primitive, (2s + 1)^2 rays a pixel, threads over the columns of the image. The errors in the
// report's formulas are corrected, its method is kept.
//
// It reads the text that scene_to_text.py writes; README.md says how to run it.

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// ---------------------------------------------------------------- vectors

struct Vec3 {
    float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(float s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return (1 / length(a)) * a; }

// ---------------------------------------------------------------- primitives

// The direction is of unit length, so `t` is a distance.
struct Ray {
    Vec3 origin, direction;
    Vec3 at(float t) const { return origin + t * direction; }
};

constexpr float miss = std::numeric_limits<float>::infinity();
constexpr float offset = 1e-3f;  // a nearer hit counts as the surface that the ray starts on

struct Material {
    Vec3 color;
    float ambient, diffuse, specular;
    float shininess;  // a whole number
    float reflection;
};

class Primitive {
public:
    explicit Primitive(const Material* m) : material(m) {}
    virtual ~Primitive() = default;
    virtual float intersect(const Ray& ray) const = 0;  // smallest t > offset, or `miss`
    // A unit vector, even if rounding has put the point beside the surface; towards either side.
    virtual Vec3 normal(const Vec3& point) const = 0;
    const Material* const material;
};

class Plane final : public Primitive {
public:
    Plane(const Material* m, const Vec3& point, const Vec3& normal)
        : Primitive(m), point_(point), normal_(unit(normal)) {}

    float intersect(const Ray& ray) const override {
        const float slope = dot(ray.direction, normal_);
        if (slope == 0) return miss;
        const float t = dot(point_ - ray.origin, normal_) / slope;
        return t > offset ? t : miss;
    }
    Vec3 normal(const Vec3&) const override { return normal_; }

private:
    Vec3 point_, normal_;
};

class Sphere final : public Primitive {
public:
    Sphere(const Material* m, const Vec3& center, float radius)
        : Primitive(m), center_(center), radius_(radius) {}

    float intersect(const Ray& ray) const override {
        const Vec3 from_center = ray.origin - center_;
        const float b = 2 * dot(from_center, ray.direction);  // a = 1
        const float c = dot(from_center, from_center) - radius_ * radius_;
        const float delta = b * b - 4 * c;
        if (delta < 0) return miss;
        const float root = std::sqrt(delta);
        const float near = (-b - root) / 2;
        if (near > offset) return near;
        const float far = (-b + root) / 2;
        return far > offset ? far : miss;
    }
    Vec3 normal(const Vec3& point) const override { return unit(point - center_); }

private:
    Vec3 center_;
    float radius_;
};

class Triangle final : public Primitive {
public:
    Triangle(const Material* m, const Vec3& a, const Vec3& b, const Vec3& c)
        : Primitive(m), a_(a), b_(b), c_(c), ab_(b - a), bc_(c - b), ca_(a - c),
          normal_(unit(cross(ab_, c - a))) {}

    float intersect(const Ray& ray) const override {
        const float slope = dot(ray.direction, normal_);
        if (slope == 0) return miss;
        const float t = dot(a_ - ray.origin, normal_) / slope;
        if (!(t > offset)) return miss;
        const Vec3 p = ray.at(t);
        if (dot(cross(ab_, p - a_), normal_) < 0) return miss;
        if (dot(cross(bc_, p - b_), normal_) < 0) return miss;
        if (dot(cross(ca_, p - c_), normal_) < 0) return miss;
        return t;
    }
    Vec3 normal(const Vec3&) const override { return normal_; }

private:
    Vec3 a_, b_, c_, ab_, bc_, ca_, normal_;
};

class Cylinder final : public Primitive {
public:
    Cylinder(const Material* m, const Vec3& bottom, float top, float radius)
        : Primitive(m), bottom_(bottom), top_(top), radius_(radius) {}

    float intersect(const Ray& ray) const override {
        const float dx = ray.direction.x, dz = ray.direction.z;
        const float px = ray.origin.x - bottom_.x, pz = ray.origin.z - bottom_.z;
        const float a = dx * dx + dz * dz;
        if (a == 0) return miss;
        const float b = 2 * (px * dx + pz * dz);
        const float c = px * px + pz * pz - radius_ * radius_;
        const float delta = b * b - 4 * a * c;
        if (delta < 0) return miss;
        const float root = std::sqrt(delta);
        const float near = (-b - root) / (2 * a);
        if (near > offset && on_wall(ray, near)) return near;
        const float far = (-b + root) / (2 * a);
        return far > offset && on_wall(ray, far) ? far : miss;
    }
    Vec3 normal(const Vec3& point) const override {
        return unit({point.x - bottom_.x, 0, point.z - bottom_.z});
    }

private:
    bool on_wall(const Ray& ray, float t) const {
        const float y = ray.origin.y + t * ray.direction.y;
        return bottom_.y <= y && y <= top_;
    }
    Vec3 bottom_;
    float top_, radius_;
};

// ---------------------------------------------------------------- scene

struct Light {
    Vec3 position, color;  // the colour times the power
};

struct Camera {
    Vec3 position, forward, right, up;  // an orthonormal frame
    float focal_length, screen_width;
};

struct Scene {
    int width = 0, height = 0, antialiasing = 0, max_reflections = 0;
    Vec3 background;
    Camera camera{};
    std::vector<Light> lights;
    std::vector<Material> materials;
    std::vector<std::unique_ptr<const Primitive>> owned;
    std::vector<const Primitive*> primitives;  // planes, spheres, triangles, cylinders
};

class Reader {
public:
    explicit Reader(std::istream& in) : in_(in) {}

    template <typename T>
    T value() {
        T v;
        if (!(in_ >> v)) throw std::runtime_error("scene: a number is missing or malformed in the section '" + last_ + "'");
        return v;
    }
    float number() { return value<float>(); }
    Vec3 vec3() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    void word(const char* expected) {
        if (!(in_ >> last_)) throw std::runtime_error(std::string("scene: ends before '") + expected + "'");
        if (last_ != expected)
            throw std::runtime_error(std::string("scene: expected '") + expected + "', got '" + last_ + "'");
    }
    std::size_t count(const char* keyword) {
        word(keyword);
        return value<std::size_t>();
    }

private:
    std::istream& in_;
    std::string last_;
};

Scene read_scene(std::istream& in) {
    Reader r(in);
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
        m.shininess = r.number();
        m.reflection = r.number();
        s.materials.push_back(m);
    }
    const auto material = [&] {
        const auto i = r.value<std::size_t>();
        if (i >= s.materials.size()) throw std::runtime_error("scene: no such material");
        return &s.materials[i];
    };
    for (std::size_t n = r.count("planes"); n > 0; --n) {
        const Vec3 point = r.vec3(), normal = r.vec3();
        s.owned.push_back(std::make_unique<Plane>(material(), point, normal));
    }
    for (std::size_t n = r.count("spheres"); n > 0; --n) {
        const Vec3 center = r.vec3();
        const float radius = r.number();
        s.owned.push_back(std::make_unique<Sphere>(material(), center, radius));
    }
    for (std::size_t n = r.count("triangles"); n > 0; --n) {
        const Vec3 a = r.vec3(), b = r.vec3(), c = r.vec3();
        s.owned.push_back(std::make_unique<Triangle>(material(), a, b, c));
    }
    for (std::size_t n = r.count("cylinders"); n > 0; --n) {
        const Vec3 bottom = r.vec3();
        const float top = r.number(), radius = r.number();
        s.owned.push_back(std::make_unique<Cylinder>(material(), bottom, top, radius));
    }
    for (const auto& p : s.owned) s.primitives.push_back(p.get());
    return s;
}

// ---------------------------------------------------------------- tracing

struct RayCount {
    std::uint64_t primary = 0, mirror = 0, shadow = 0;
};

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

// With COUNTING false nothing is counted, and the compiler removes the code for it.
template <bool COUNTING>
class Tracer {
public:
    explicit Tracer(const Scene& scene)
        : scene_(scene), grid_(sample_grid(scene.antialiasing)),
          axis_(scene.camera.focal_length * scene.camera.forward),
          pixel_(scene.camera.screen_width / float(scene.width)) {}

    Vec3 pixel(int i, int j) {
        Vec3 color;
        for (const Sample& s : grid_) {
            const float x = float(i) + 0.5f + s.dx - float(scene_.width) / 2;
            const float y = float(scene_.height) / 2 - (float(j) + 0.5f + s.dy);
            const Vec3 direction = axis_ + pixel_ * x * scene_.camera.right + pixel_ * y * scene_.camera.up;
            if (COUNTING) ++count.primary;
            color = color + s.weight * trace({scene_.camera.position, unit(direction)}, 0);
        }
        return color;
    }

    RayCount count;

private:
    Vec3 trace(const Ray& ray, int bounce) {
        const Primitive* hit = nullptr;
        float nearest = miss;
        for (const Primitive* p : scene_.primitives) {
            const float t = p->intersect(ray);
            if (t < nearest) {
                nearest = t;
                hit = p;
            }
        }
        if (!hit) return scene_.background;

        const Material& material = *hit->material;
        const Vec3 point = ray.at(nearest);
        Vec3 normal = hit->normal(point);
        if (dot(normal, ray.direction) > 0) normal = -normal;

        const Vec3 color = surface(material, point, normal, ray.direction);
        const float k = material.reflection;
        if (!(k > 0)) return color;
        if (bounce == scene_.max_reflections) return (1 - k) * color;
        if (COUNTING) ++count.mirror;
        const Vec3 mirrored = ray.direction - 2 * dot(normal, ray.direction) * normal;
        return (1 - k) * color + k * trace({point, mirrored}, bounce + 1);
    }

    Vec3 surface(const Material& material, const Vec3& point, const Vec3& normal, const Vec3& direction) {
        Vec3 color = material.ambient * material.color;
        for (const Light& light : scene_.lights) {
            const Vec3 way = light.position - point;
            const float distance = length(way);
            if (distance == 0) continue;
            const Vec3 l = (1 / distance) * way;
            const float facing = dot(normal, l);
            if (facing <= 0 || in_shadow({point, l}, distance)) continue;
            const float highlight = dot(2 * facing * normal - l, -direction);
            Vec3 lit = material.diffuse * facing * material.color;
            if (highlight > 0) {
                const float s = material.specular * std::pow(highlight, material.shininess);
                lit = lit + Vec3{s, s, s};
            }
            color = color + lit * light.color;
        }
        return color;
    }

    bool in_shadow(const Ray& ray, float distance) {
        if (COUNTING) ++count.shadow;
        for (const Primitive* p : scene_.primitives)
            if (p->intersect(ray) < distance - offset) return true;
        return false;
    }

    const Scene& scene_;
    const std::vector<Sample> grid_;
    const Vec3 axis_;
    const float pixel_;
};

// ---------------------------------------------------------------- the image

using Image = std::vector<Vec3>;  // row by row, the top one first

enum class Schedule { fixed, dynamic, mutex };

void render(const Scene& scene, Schedule schedule, int threads, Image& image) {
    const int width = scene.width, height = scene.height;
    Tracer<false> tracer(scene);
    const auto column = [&](int i) {
        for (int j = 0; j < height; ++j) image[std::size_t(j) * width + i] = tracer.pixel(i, j);
    };
    if (schedule == Schedule::fixed) {
#pragma omp parallel for schedule(static) num_threads(threads)
        for (int i = 0; i < width; ++i) column(i);
    } else if (schedule == Schedule::dynamic) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
        for (int i = 0; i < width; ++i) column(i);
    } else {
        std::mutex lock;
        const auto share = [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t p = begin; p < end; ++p) {
                const int i = int(p / height), j = int(p % height);
                const Vec3 color = tracer.pixel(i, j);
                const std::lock_guard<std::mutex> guard(lock);
                image[std::size_t(j) * width + i] = color;
            }
        };
        const std::int64_t pixels = std::int64_t(width) * height;
        std::vector<std::thread> team;
        for (int k = 0; k < threads; ++k)
            team.emplace_back(share, pixels * k / threads, pixels * (k + 1) / threads);
        for (std::thread& t : team) t.join();
    }
}

RayCount count_rays(const Scene& scene) {
    Tracer<true> tracer(scene);
    for (int i = 0; i < scene.width; ++i)
        for (int j = 0; j < scene.height; ++j) tracer.pixel(i, j);
    return tracer.count;
}

bool ends_with(const std::string& s, const std::string& end) {
    return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}

void write_image(const std::string& path, const Image& image, int width, int height) {
    std::string data;
    if (ends_with(path, ".pfm")) {  // little-endian floats, the bottom row first
        data = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
        for (int j = height - 1; j >= 0; --j)
            data.append(reinterpret_cast<const char*>(&image[std::size_t(j) * width]), sizeof(Vec3) * width);
    } else {
        data = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
        for (const Vec3& c : image)
            for (const float v : {c.x, c.y, c.z})
                data.push_back(char(int(255 * std::min(std::max(v, 0.0f), 1.0f) + 0.5f)));
    }
    std::ofstream out(path, std::ios::binary);
    if (!out.write(data.data(), std::streamsize(data.size())).flush())
        throw std::runtime_error("cannot write " + path);
}

// ---------------------------------------------------------------- the command

constexpr const char* usage =
    "usage: report SCENE.txt [options]          (SCENE.txt as scene_to_text.py writes it; - reads stdin)\n"
    "  --threads N             threads, default 1\n"
    "  --schedule KIND         static (default), dynamic, or mutex\n"
    "  --size WxH              pixels, instead of the scene's\n"
    "  --antialiasing N        lattice density, 0..32, instead of the scene's\n"
    "  --repeat R              timed runs, default 1\n"
    "  --count                 count the rays in a separate run before the timed ones\n"
    "  -o FILE                 the image: .ppm or .pfm\n";

int integer(const std::string& text, int low, int high, const char* what) {
    char* end = nullptr;
    const long v = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || v < low || v > high)
        throw std::runtime_error(std::string(what) + ": expected an integer from " + std::to_string(low) + " to " +
                                 std::to_string(high) + ", got '" + text + "'");
    return int(v);
}

int run(int argc, char** argv) {
    std::string path, output, size, antialiasing, schedule_name = "static";
    int threads = 1, repeat = 1;
    bool counting = false;
    for (int a = 1; a < argc; ++a) {
        const std::string arg = argv[a];
        const auto next = [&]() -> std::string {
            if (a + 1 >= argc) throw std::runtime_error(arg + " needs a value");
            return argv[++a];
        };
        if (arg == "--threads") threads = integer(next(), 1, 1024, "--threads");
        else if (arg == "--schedule") schedule_name = next();
        else if (arg == "--size") size = next();
        else if (arg == "--antialiasing") antialiasing = next();
        else if (arg == "--repeat") repeat = integer(next(), 1, 1000000, "--repeat");
        else if (arg == "--count") counting = true;
        else if (arg == "-o") output = next();
        else if (arg == "-h" || arg == "--help") return std::fputs(usage, stdout), 0;
        else if (path.empty() && (arg == "-" || arg[0] != '-')) path = arg;
        else throw std::runtime_error("unexpected argument '" + arg + "'");
    }
    if (path.empty()) throw std::runtime_error(std::string("no scene given\n") + usage);
    if (!output.empty() && !ends_with(output, ".ppm") && !ends_with(output, ".pfm"))
        throw std::runtime_error("-o: expected a name that ends in .ppm or .pfm");
    Schedule schedule = Schedule::fixed;
    if (schedule_name == "dynamic") schedule = Schedule::dynamic;
    else if (schedule_name == "mutex") schedule = Schedule::mutex;
    else if (schedule_name != "static") throw std::runtime_error("--schedule: static, dynamic or mutex");

    std::ifstream file;
    if (path != "-") {
        file.open(path);
        if (!file) throw std::runtime_error("cannot read " + path);
    }
    Scene scene = read_scene(path == "-" ? std::cin : file);
    if (!size.empty()) {
        const auto by = size.find('x');
        scene.width = integer(size.substr(0, by), 1, 65535, "--size");
        scene.height = integer(by == std::string::npos ? "" : size.substr(by + 1), 1, 65535, "--size");
    }
    if (!antialiasing.empty()) scene.antialiasing = integer(antialiasing, 0, 32, "--antialiasing");

    std::string rays = "null";
    if (counting) {
        const RayCount c = count_rays(scene);
        rays = "{\"primary\":" + std::to_string(c.primary) + ",\"mirror\":" + std::to_string(c.mirror) +
               ",\"shadow\":" + std::to_string(c.shadow) +
               ",\"total\":" + std::to_string(c.primary + c.mirror + c.shadow) + "}";
    }
    Image image(std::size_t(scene.width) * scene.height);
    for (int r = 0; r < repeat; ++r) {
        const auto start = std::chrono::steady_clock::now();
        render(scene, schedule, threads, image);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        std::printf("{\"repeat\":%d,\"seconds\":%.6f,\"width\":%d,\"height\":%d,\"antialiasing\":%d,\"threads\":%d,"
                    "\"schedule\":\"%s\",\"rays\":%s}\n",
                    r, spent.count(), scene.width, scene.height, scene.antialiasing, threads,
                    schedule_name.c_str(), rays.c_str());
        std::fflush(stdout);
    }
    if (!output.empty()) write_image(output, image, scene.width, scene.height);
    return 0;
}

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "report: %s\n", e.what());
        return 1;
    }
}
