// Sequences of frames of the C interface.
#include "plugins/c/handles.h"
#include "session/denoise/bmfr_sequence.h"

using namespace mote;

struct mote_sequence {
    session::BmfrSequence frames{false};
};

mote_sequence* mote_sequence_new(void) {
    mote_sequence* sequence = nullptr;
    c::LastError unheard;
    c::guarded(unheard, [&] { sequence = new mote_sequence; });
    return sequence;
}
void mote_sequence_free(mote_sequence* sequence) { delete sequence; }

mote_status mote_sequence_denoise(mote_sequence* sequence, mote_picture* frame) {
    if (!sequence || !frame) return MOTE_INVALID_ARGUMENT;
    return c::guarded(frame->error, [&] {
        core::ImageChannels image = frame->rendered.image;
        sequence->frames.add_denoised_layer(image);
        frame->rendered.image = std::move(image);
        frame->layers = session::layers_of(frame->rendered.image);
    });
}
