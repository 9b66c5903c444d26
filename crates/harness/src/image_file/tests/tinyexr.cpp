// Prints an EXR file as TinyEXR reads it: its structure, then the bits of the channels R, G and B
// of each pixel, row by row.

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <tinyexr.h>

int main(int, char **arguments) {
    EXRVersion version;
    EXRHeader header;
    EXRImage image;
    InitEXRHeader(&header);
    InitEXRImage(&image);
    const char *error = nullptr;
    if (ParseEXRVersionFromFile(&version, arguments[1]) != TINYEXR_SUCCESS ||
        ParseEXRHeaderFromFile(&header, &version, arguments[1], &error) != TINYEXR_SUCCESS ||
        LoadEXRImageFromFile(&image, &header, arguments[1], &error) != TINYEXR_SUCCESS) {
        std::fprintf(stderr, "%s\n", error ? error : "not an EXR file");
        return 1;
    }
    std::printf("%dx%d tiled %d compression %d channels", image.width, image.height, header.tiled,
                header.compression_type);
    for (int channel = 0; channel < header.num_channels; channel++) {
        std::printf(" %s", header.channels[channel].name);
    }
    std::printf("\n");
    for (int pixel = 0; pixel < image.width * image.height; pixel++) {
        for (int channel = 2; channel >= 0; channel--) {
            uint32_t bits;
            std::memcpy(&bits, image.images[channel] + 4 * pixel, 4);
            std::printf("%08x\n", bits);
        }
    }
}
