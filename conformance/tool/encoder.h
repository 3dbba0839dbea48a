/* encoder.h - `ted4conf encode`: an encoder against what specification 3.4 asks of it, by the
 * contract of conformance/README.md.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_ENCODER_H
#define CONF_ENCODER_H

typedef struct {
    const char *encoder; /* command */
    const char *scene;   /* folder, as the encoder knows them */
    const char *preset;  /* NULL: the encoder's own choice */
    double timeout;      /* seconds */
} conf_encode_options;

/* Says on stderr what is wrong, and the verdict in one line on stdout. Exit code: 0 conforms, 1
 * does not, 3 no temporary folder. */
int conf_encode(const conf_encode_options *o);

#endif
