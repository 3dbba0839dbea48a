/* ted4enc.c - trains a scene and writes it as a .ted4 file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "encode_main.h"

int main(int argc, char **argv)
{
    return ted4_encoder_main(argc, argv, NULL);
}
