// The loop over the pixels of a pass for every method: tasks, eye samples, interleaving, and upsampling from
// a lattice of pixels; sixteen eye paths at a time, or one after the other.
//
//   ImageLoop<Media> loop(scene, options, {.interleaving = n});
//   loop.run(context, image, packet_settings, [&](EyeTask<Media>& task) {     // on many threads
//       Gatherer gatherer(task.packet(), ...);                                // state of one task
//       task.for_each([&](const PacketPixels& pixels) { gatherer.run(pixels); });
//   });
//
// for_each() starts the packet's paths before each call, and stores the lanes' sums after it; trace_each() is
// the same for paths one by one, and for_each_pixel() for methods that write to the image themselves.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_packet.h"
#include "integrators/layer_filter/layer_filter.h"

namespace mote::integrators {

struct ImageLoopSettings {
    /// n: the pixels of a packet lie n apart, and each place in blocks of n x n has one of n^2 shares of the
    /// lights.
    int interleaving = 1;
    /// n: light of `upsampled` layers is gathered at one pixel of n x n, and interpolated between.
    int upsampling = 1;
    int eye_samples = 1;  ///< eye paths a pixel and pass
    /// A packet holds sixteen pixels of a row instead of 4 x 4: tasks visit their pixels row by row.
    bool by_rows = false;
    std::vector<LayerFilter::Choice> upsampled{};
};

/// Pixels of the paths of a packet.
struct PacketPixels {
    std::array<glm::ivec2, 16> pixels;  ///< x < 0: none
    int place = 0;                      ///< in blocks of interleaved pixels, y after x
    std::size_t share = 0;              ///< of the lights, in this pass
    bool gathers = true;                ///< false: between the lattice; receivers are only recorded
    int sample = 0;                     ///< eye path of each pixel

    /// Lane of a pixel; -1: it is none of these.
    int lane_of(int x, int y) const {
        const auto found = std::ranges::find(pixels, glm::ivec2(x, y));
        return found == pixels.end() ? -1 : int(found - pixels.begin());
    }
    /// Calls visit(lane, x, y) for the pixels that there are.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (pixels[i].x >= 0) visit(i, pixels[i].x, pixels[i].y);
    }
};

/// Rows of the image from `begin` to before `end`.
struct PixelRows {
    int begin = 0;                              ///< the first
    int end = std::numeric_limits<int>::max();  ///< after the last
};

/// A part of the image that one thread renders.
template <bool Media>
class EyeTask {
  public:
    /// ImageLoop makes it; what it is given must outlive it.
    EyeTask(const core::Scene& scene, const core::RenderOptions& options, const core::PassContext& context,
            const EyePacketSettings& settings, int samples)
        : scene_(scene), options_(options), context_(context), settings_(settings), samples_(samples) {
        walk_.cancelled = context.cancelled;
    }

    core::WalkContext& walk() { return walk_; }  ///< generator and counters of the task
    /// Sixteen eye paths, made on first use.
    EyePacket<Media>& packet() {
        if (!packet_) packet_ = std::make_unique<EyePacket<Media>>(scene_, settings_, walk_);
        return *packet_;
    }
    std::size_t index() const { return index_; }  ///< below ImageLoop::tasks()
    int samples() const { return samples_; }      ///< eye paths a pixel

    /// Calls render(pixels) for every packet of the task and eye sample, its paths started, and stores what
    /// they found, as the mean over the samples. `stored(pixels)` follows, and may add to the image.
    template <typename Render, typename Stored>
    void for_each(const Render& render, const Stored& stored) {
        for (PacketPixels& pixels : packets_) {
            if (context_.cancelled) return;  // many lights take long
            std::array<TransportSum, EyePacket<Media>::width> sums{};
            for (pixels.sample = 0; pixels.sample < samples_; ++pixels.sample) {
                start(pixels);
                render(std::as_const(pixels));
                for (std::size_t i = 0; i < sums.size(); ++i) sums[i].add(packet()[int(i)].sum);
            }
            store_means(pixels, sums);
            stored(std::as_const(pixels));
        }
    }
    /// Without.
    template <typename Render>
    void for_each(const Render& render) {
        for_each(render, [](const PacketPixels&) {});
    }

    /// For methods that follow one path after the other: stores the mean of trace(EyeRay), a TransportSum,
    /// over the eye samples of each pixel. The walk's generator is the path's.
    template <typename Trace>
    void trace_each(const Trace& trace) {
        for_each_pixel([&](int x, int y) {
            if (context_.cancelled) return;
            TransportSum mean;
            for (int k = 0; k < samples_; ++k) {
                const EyeRay eye = eye_ray(context_of(k), x, y);
                walk_.rng = eye.rng;
                const TransportSum one = trace(eye);
                for (std::size_t i = 0; i < transport_count; ++i)
                    mean.light[i] += one.light[i] / float(samples_);
            }
            store(mean, *image_, x, y, Media);
        });
    }

    /// For methods that write to the image themselves: calls visit(x, y) for every pixel of the task.
    template <typename Visit>
    void for_each_pixel(const Visit& visit) const {
        for (const PacketPixels& packet : packets_)
            packet.for_each([&](std::size_t, int x, int y) { visit(x, y); });
    }

    /// For methods with paths of their own, one a pixel: calls start(EyeRay) for all pixels of the task, and
    /// stores sum(number) of each, a TransportSum, after run().
    template <typename Paths>
    void trace_all(Paths& paths) {
        paths.clear();
        for_each_pixel([&](int x, int y) { paths.start(eye_ray(context_, x, y)); });
        paths.run();
        int number = 0;
        for_each_pixel([&](int x, int y) { store(paths.sum(number++), *image_, x, y, Media); });
    }

  private:
    template <bool>
    friend class ImageLoop;

    /// Eye paths are numbered on from pass to pass.
    core::PassContext context_of(int sample) const {
        return {context_.index * std::uint32_t(samples_) + std::uint32_t(sample), context_.filter,
                context_.cancelled, context_.part};
    }
    /// The eye ray of a pixel; the image has its place where it is the only one.
    EyeRay eye_ray(const core::PassContext& context, int x, int y) const {
        const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
        if (samples_ == 1) image_->place(x, y, eye.film);
        return eye;
    }
    void start(const PacketPixels& pixels) {
        const core::PassContext eye = context_of(pixels.sample);
        for (int i = 0; i < EyePacket<Media>::width; ++i)
            if (const glm::ivec2 p = pixels.pixels[std::size_t(i)]; p.x >= 0)
                packet().start(i, eye_ray(eye, p.x, p.y));
            else
                packet().stop(i);
    }
    void store_means(const PacketPixels& pixels, const std::array<TransportSum, 16>& sums) {
        pixels.for_each([&](std::size_t i, int x, int y) {
            TransportSum mean = sums[i];
            for (core::Rgb& light : mean.light) light /= float(samples_);
            store(mean, *image_, x, y, Media);
            if (shared_) shared_->set(x, y, packet()[int(i)].seen);
        });
    }

    const core::Scene& scene_;
    const core::RenderOptions& options_;
    const core::PassContext& context_;
    const EyePacketSettings& settings_;
    int samples_;
    core::WalkContext walk_;
    std::unique_ptr<EyePacket<Media>> packet_;
    std::vector<PacketPixels> packets_;
    core::PassImage* image_ = nullptr;
    SharedPixels* shared_ = nullptr;
    std::size_t index_ = 0;
};

/// The pixels of an image in packets, whatever the template of the eye paths.
class PacketLayout {
  public:
    /// For an image of this size.
    PacketLayout(const core::RenderOptions& options, const ImageLoopSettings& settings);
    int tile_size() const { return tile_size_; }  ///< pixels along an edge of a task
    int columns() const { return (width_ + tile_size_ - 1) / tile_size_; }  ///< of tasks
    int rows() const { return (height_ + tile_size_ - 1) / tile_size_; }    ///< of tasks
    /// Index of the task of a pixel.
    std::size_t task_of(int x, int y) const {
        return std::size_t(y / tile_size_ * columns() + x / tile_size_);
    }
    /// The lattice of upsampling goes round from pass to pass.
    screenspace::ShadedLattice lattice(std::uint32_t pass) const;
    /// Packets of the pixels from (x0, y0) to before (x1, y1). `lattice`: pixels that gather; null: all.
    std::vector<PacketPixels> packets(int x0, int y0, int x1, int y1, std::uint32_t pass,
                                      const screenspace::ShadedLattice* lattice) const;
    /// Packets of pixels by their indices.
    std::vector<PacketPixels> packets(std::span<const std::uint32_t> pixels) const;

  private:
    std::size_t share_of(int place, std::uint32_t pass) const;

    int width_, height_, interleaving_, upsampling_, across_, tile_size_;
    std::size_t first_share_;
};

/// Calls task(range) for ranges of `pixels` in parallel.
void for_each_range(std::span<const std::uint32_t> pixels, const std::atomic<bool>& cancelled,
                    const std::function<void(std::span<const std::uint32_t>)>& task);

/// The loop; `Media`: eye paths see media.
template <bool Media>
class ImageLoop {
  public:
    /// The scene must outlive it.
    ImageLoop(const core::Scene& scene, const core::RenderOptions& options, ImageLoopSettings settings = {})
        : scene_(scene), options_(options), settings_(std::move(settings)), layout_(options, settings_) {}

    /// Renders the pixels of a pass, or of some of its rows, which begin at a multiple of tile_size(),
    /// without upsampling; task(EyeTask&) is called on many threads. Returns false where it was cancelled.
    template <typename Task>
    bool run(const core::PassContext& context, core::PassImage& image, EyePacketSettings eye,
             const Task& task, PixelRows rows = {}) {
        std::optional<SharedPixels> shared;
        if (settings_.upsampling > 1) {
            shared.emplace(options_.width, options_.height, layout_.lattice(context.index));
            image.finish_late();
        }
        eye.records_seen = shared.has_value();
        const auto render = [&](std::vector<PacketPixels> packets, std::size_t index, SharedPixels* seen) {
            run_task(context, image, eye, std::move(packets), index, seen, task);
        };
        const int size = layout_.tile_size(), count = std::min(rows.end, options_.height) - rows.begin;
        const auto tile = [&](int x0, int y0, int x1, int y1) {
            y0 += rows.begin, y1 += rows.begin;
            render(layout_.packets(x0, y0, x1, y1, context.index, shared ? &shared->lattice() : nullptr),
                   layout_.task_of(x0, y0), shared ? &*shared : nullptr);
        };
        if (!core::for_each_tile(options_.width, count, size, context.cancelled, tile)) return false;
        return !shared || upsample(context, *shared, image, render);
    }

    /// Renders a pixel's packet, after those before it in its task, from which selectors learn. Where pixels
    /// are upsampled, the ones between the lattice gather nothing.
    template <typename Task>
    void run_pixel(const core::PassContext& context, core::PassImage& image, const EyePacketSettings& eye,
                   int x, int y, const Task& task) {
        const int size = layout_.tile_size(), x0 = x / size * size, y0 = y / size * size;
        const screenspace::ShadedLattice lattice = layout_.lattice(context.index);
        std::vector<PacketPixels> packets =
            layout_.packets(x0, y0, std::min(x0 + size, options_.width), std::min(y0 + size, options_.height),
                            context.index, settings_.upsampling > 1 ? &lattice : nullptr);
        const auto own =
            std::ranges::find_if(packets, [&](const PacketPixels& p) { return p.lane_of(x, y) >= 0; });
        packets.erase(own + 1, packets.end());
        run_task(context, image, eye, std::move(packets), layout_.task_of(x, y), nullptr, task);
    }

    /// Upper bound of EyeTask::index().
    std::size_t tasks() const { return std::size_t(layout_.columns()) * std::size_t(layout_.rows()); }
    SharedCounters& counters() { return counters_; }  ///< of all tasks so far
    /// Rays and lookups, for Estimator::add_statistics().
    void add_statistics(core::Statistics& statistics) const {
        counters_.report(statistics, Media);
        if (settings_.upsampling > 1) statistics.values["pixels_shaded_again"] += double(shaded_again_);
    }

  private:
    template <typename Task>
    void run_task(const core::PassContext& context, core::PassImage& image, const EyePacketSettings& eye,
                  std::vector<PacketPixels> packets, std::size_t index, SharedPixels* seen,
                  const Task& task) {
        EyeTask<Media> own(scene_, options_, context, eye, settings_.eye_samples);
        own.packets_ = std::move(packets), own.index_ = index, own.image_ = &image, own.shared_ = seen;
        task(own);
        counters_.add(own.walk_.rays, own.walk_.tracking);
    }
    /// Pixels between the lattice: those without similar neighbours once more, with lights of their own, the
    /// others by neighbours.
    template <typename Render>
    bool upsample(const core::PassContext& context, const SharedPixels& shared, core::PassImage& image,
                  const Render& render) {
        const std::vector<std::uint32_t> again = shared.again();
        for_each_range(again, context.cancelled, [&](std::span<const std::uint32_t> pixels) {
            render(layout_.packets(pixels), 0, nullptr);
        });
        shaded_again_ += again.size();
        if (context.cancelled) return false;
        for (const LayerFilter::Choice& l : settings_.upsampled) shared.fill(l.kind, image.layer(l.layer));
        return true;
    }

    const core::Scene& scene_;
    core::RenderOptions options_;
    ImageLoopSettings settings_;
    PacketLayout layout_;
    SharedCounters counters_;
    std::uint64_t shaded_again_ = 0;
};

}  // namespace mote::integrators
