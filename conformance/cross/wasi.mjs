// wasi.mjs - runs a WebAssembly program under Node's WASI with the whole file system:
// node wasi.mjs PROGRAM.wasm [ARGUMENT...]
// Relative paths of the program begin at /, so that files are to be named from there.
// SPDX-License-Identifier: BSD-2-Clause
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const args = process.argv.slice(2);
const wasi = new WASI({
    version: 'preview1', args, env: process.env, preopens: { '/': '/' }, returnOnExit: true
});
const program = await WebAssembly.compile(await readFile(args[0]));
const instance = await WebAssembly.instantiate(program, {
    wasi_snapshot_preview1: wasi.wasiImport
});
process.exitCode = wasi.start(instance);
