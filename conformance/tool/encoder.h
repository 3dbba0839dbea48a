/* encoder.h - `ted4conf encode`: checks an encoder against the requirements of specification 3.4,
 * through the contract of conformance/README.md.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_ENCODER_H
#define CONF_ENCODER_H

typedef struct {
    const char *encoder; /* command */
    const char *scene;   /* folder, in a form that the encoder understands */
    const char *preset;  /* NULL: the encoder's default */
    double timeout;      /* seconds */
} conf_encode_options;

/* Prints the problems to stderr and a verdict of one line to stdout. Returns the exit code: 0 the
 * encoder conforms, 1 it does not, 3 there is no temporary folder. */
int conf_encode(const conf_encode_options *o);

#endif
