// index.js - the package ted4. SPDX-License-Identifier: BSD-2-Clause
export { Decoder, Scene, Ted4Error } from "./decoder.js";
export { Ted4Client } from "./client.js";
export { timeOfFragment, timeOfFrame, timeOfSeconds } from "./times.js";
