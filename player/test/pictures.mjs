// pictures.mjs - compares pictures, with a page of a browser as the reader and writer of PNG and
// JPEG. Pictures are base64.
// SPDX-License-Identifier: BSD-2-Clause

const LOAD = `async (base64) => {
  const blob = await (await fetch("data:image/png;base64," + base64)).blob();
  return createImageBitmap(blob, { colorSpaceConversion: "none" });
}`;

// In decibels, over all pixels and the three colours.
export function psnr(page, a, b) {
  return page.evaluate(`(async () => {
    const load = ${LOAD};
    const pixels = async (base64) => {
      const image = await load(base64);
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    };
    const a = await pixels("${a}"), b = await pixels("${b}");
    if (a.length !== b.length) throw new Error("pictures of different sizes");
    let sum = 0;
    for (let i = 0; i < a.length; i++) sum += i % 4 === 3 ? 0 : (a[i] - b[i]) ** 2;
    return sum === 0 ? 99 : 10 * Math.log10(255 * 255 * 0.75 * a.length / sum);
  })()`);
}

// A JPEG of the PNGs from left to right.
export function sideBySide(page, pictures, quality = 0.85) {
  return page.evaluate(`(async () => {
    const load = ${LOAD};
    const images = await Promise.all(${JSON.stringify(pictures)}.map(load));
    const canvas = document.createElement("canvas");
    canvas.width = images.reduce((sum, { width }) => sum + width, 0);
    canvas.height = images[0].height;
    let x = 0;
    for (const image of images) {
      canvas.getContext("2d").drawImage(image, x, 0);
      x += image.width;
    }
    return canvas.toDataURL("image/jpeg", ${quality}).split(",")[1];
  })()`);
}
