#include <mote/lights/virtual_lights/vpl_gather.h>
#include <mote/version.h>

int main() { return MOTE_VERSION_NUMBER == 0 || sizeof(mote::lights::ReceiverTile) == 0; }
