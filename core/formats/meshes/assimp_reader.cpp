// All formats but OBJ and PLY, through assimp.
//
// Damaged files make assimp's readers crash, loop and allocate without measure. So a child process reads the
// file, under limits on time and memory, and sends the finished mesh through a pipe.
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <chrono>
#include <cstring>
#include <fstream>

#include "core/files/whole_file.h"
#include "core/formats/meshes/mesh_file.h"
#include "core/geometry/mesh_edits.h"
#include "core/geometry/polygon_triangulation.h"

namespace mote::core {
namespace {

constexpr int time_limit_seconds = 60;
constexpr std::size_t max_message = 200;          // assimp may quote much of a file
constexpr rlim_t memory_limit = rlim_t(4) << 30;  // bytes, beyond what the process has mapped already

Transform transform_of(const aiMatrix4x4& m) {
    return Transform(glm::transpose(glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4,  //
                                               m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4)));
}

/// Appends `more`, filling in normals and texture coordinates where only one of the two has them.
void append(MeshData& data, const MeshData& more) {
    const auto first = std::uint32_t(data.positions.size());
    if (data.normals.empty() && !more.normals.empty()) data.normals.resize(first, Vec3(0.0f));
    if (data.uvs.empty() && !more.uvs.empty()) data.uvs.resize(first, Vec2(0.0f));
    const bool normals = !data.normals.empty() || !more.normals.empty();
    const bool uvs = !data.uvs.empty() || !more.uvs.empty();
    data.positions.insert(data.positions.end(), more.positions.begin(), more.positions.end());
    data.normals.insert(data.normals.end(), more.normals.begin(), more.normals.end());
    data.uvs.insert(data.uvs.end(), more.uvs.begin(), more.uvs.end());
    if (normals) data.normals.resize(data.positions.size(), Vec3(0.0f));
    if (uvs) data.uvs.resize(data.positions.size(), Vec2(0.0f));
    for (const auto& t : more.triangles) data.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

MeshFile convert(const aiMesh& mesh, bool flip_v) {
    MeshFile file;
    MeshData& data = file.data;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D& p = mesh.mVertices[i];
        data.positions.emplace_back(p.x, p.y, p.z);
        if (mesh.HasNormals()) {
            const aiVector3D& n = mesh.mNormals[i];
            data.normals.emplace_back(n.x, n.y, n.z);
        }
        if (mesh.HasTextureCoords(0)) {
            const aiVector3D& uv = mesh.mTextureCoords[0][i];
            data.uvs.emplace_back(uv.x, flip_v ? 1.0f - uv.y : uv.y);
        }
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        const std::span<const std::uint32_t> polygon(face.mIndices, face.mNumIndices);
        for (const std::uint32_t vertex : polygon)
            if (vertex >= mesh.mNumVertices) throw InputError("a face refers to a vertex that is not there");
        if (polygon.size() < 3) ++file.other_dropped;
        triangulate_polygon(polygon, data.positions, data.triangles);
    }
    return file;
}

/// The scene's meshes as its nodes place them, depth first.
MeshFile convert(const aiScene& scene, bool flip_v) {
    MeshFile all;
    std::vector<std::pair<const aiNode*, Transform>> stack{{scene.mRootNode, Transform()}};
    while (!stack.empty()) {
        const auto [node, parent] = stack.back();
        stack.pop_back();
        if (!node) continue;
        const Transform to_world = parent * transform_of(node->mTransformation);
        for (unsigned i = 0; i < node->mNumMeshes; ++i) {
            MeshFile file = convert(*scene.mMeshes[node->mMeshes[i]], flip_v);
            transform_mesh(file.data, to_world);
            append(all.data, file.data);
            all.other_dropped += file.other_dropped;
        }
        for (unsigned i = node->mNumChildren; i-- > 0;) stack.emplace_back(node->mChildren[i], to_world);
    }
    return all;
}

/// Content of the pipe: sizes, then the arrays. An error is a message instead.
struct Header {
    std::uint64_t message, positions, normals, uvs, triangles, other_dropped;
};

bool write_all(int pipe, const void* data, std::size_t size) {
    for (const char* bytes = static_cast<const char*>(data); size > 0;) {
        const ssize_t n = write(pipe, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n, size -= std::size_t(n);
    }
    return true;
}

template <typename T>
bool write_vector(int pipe, const std::vector<T>& v) {
    return write_all(pipe, v.data(), v.size() * sizeof(T));
}

void limit_resources() {
    rlimit limit{rlim_t(time_limit_seconds), rlim_t(time_limit_seconds)};
    setrlimit(RLIMIT_CPU, &limit);
    limit = {0, 0};
    setrlimit(RLIMIT_CORE, &limit);
#if !defined(__SANITIZE_ADDRESS__)  // whose shadow memory takes terabytes of address space
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t bytes = rlim_t(pages) * rlim_t(sysconf(_SC_PAGESIZE)) + memory_limit;
    limit = {bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

bool read_and_send(const std::string& path, bool flip_v, int pipe) {
    std::string message;
    MeshFile file;
    try {
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(path, 0);
        if (scene) {
            file = convert(*scene, flip_v);
        } else {
            message = importer.GetErrorString();
        }
    } catch (const std::exception& error) {
        message = error.what();
    }
    if (message.empty() && file.data.triangles.empty()) message = "the mesh has no triangles";
    const Header header{message.size(),       file.data.positions.size(), file.data.normals.size(),
                        file.data.uvs.size(), file.data.triangles.size(), file.other_dropped};
    if (!write_all(pipe, &header, sizeof(header))) return false;
    if (!message.empty()) return write_all(pipe, message.data(), message.size());
    return write_vector(pipe, file.data.positions) && write_vector(pipe, file.data.normals) &&
           write_vector(pipe, file.data.uvs) && write_vector(pipe, file.data.triangles);
}

/// The child process: killed and reaped when this goes out of scope.
class Child {
  public:
    Child(const std::string& path, bool flip_v) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe to read a mesh through");
        pid_ = fork();
        if (pid_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            close(ends[0]);
            signal(SIGPIPE, SIG_IGN);
            limit_resources();
            _exit(read_and_send(path, flip_v, ends[1]) ? 0 : 1);
        }
        close(ends[1]);
        pipe_ = ends[0];
        if (pid_ < 0) {
            close(pipe_);
            throw std::runtime_error("no process to read a mesh in");
        }
    }
    ~Child() {
        close(pipe_);
        kill(pid_, SIGKILL);
        while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Throws InputError when the child ended or the time ran out before all bytes came.
    void read_all(void* data, std::size_t size) {
        for (char* bytes = static_cast<char*>(data); size > 0;) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                deadline_ - std::chrono::steady_clock::now());
            pollfd ready{pipe_, POLLIN, 0};
            const int polled = left.count() > 0 ? poll(&ready, 1, int(left.count())) : 0;
            if (polled < 0 && errno == EINTR) continue;
            if (polled == 0) throw InputError("reading the mesh took more than a minute");
            const ssize_t n = ::read(pipe_, bytes, size);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) throw InputError("the file is damaged: its reader crashed or ran out of memory");
            bytes += n, size -= std::size_t(n);
        }
    }
    template <typename T>
    void read_vector(std::vector<T>& v, std::uint64_t size) {
        v.resize(size);
        read_all(v.data(), size * sizeof(T));
    }

  private:
    pid_t pid_ = -1;
    int pipe_ = -1;
    std::chrono::steady_clock::time_point deadline_ =
        std::chrono::steady_clock::now() + std::chrono::seconds(time_limit_seconds);
};

}  // namespace

MeshFile read_with_assimp(const std::string& path, bool flip_v) {
    try {
        require_file(path);
        Child child(path, flip_v);
        Header header;
        child.read_all(&header, sizeof(header));
        if (header.message > 0) {
            std::string message(std::min<std::uint64_t>(header.message, 1000), ' ');
            child.read_all(message.data(), message.size());
            throw InputError(printable(message, max_message));
        }
        MeshFile file;
        child.read_vector(file.data.positions, header.positions);
        child.read_vector(file.data.normals, header.normals);
        child.read_vector(file.data.uvs, header.uvs);
        child.read_vector(file.data.triangles, header.triangles);
        file.other_dropped = header.other_dropped;
        return file;
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
}

}  // namespace mote::core
