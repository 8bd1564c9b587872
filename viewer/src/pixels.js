// Images as the report holds them: interleaved RGB in half floats, little endian, times a power of two.

/** Values of all 65536 halfs. */
const halfs = (() => {
  const table = new Float32Array(1 << 16);
  for (let bits = 0; bits < 1 << 16; ++bits) {
    const exponent = (bits >> 10) & 31;
    const fraction = bits & 1023;
    const size =
      exponent === 0
        ? fraction * 2 ** -24
        : exponent === 31
          ? fraction
            ? NaN
            : Infinity
          : (1 + fraction / 1024) * 2 ** (exponent - 15);
    table[bits] = bits >> 15 ? -size : size;
  }
  return table;
})();

/**
 * @param {{width: number, height: number, scale: number, pixels: string}} image  `pixels` in base64
 * @returns {Float32Array} 3 x width x height values, row by row from the top
 */
export function decodePixels(image) {
  const bytes = Uint8Array.from(atob(image.pixels), (c) => c.charCodeAt(0));
  const values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i)
    values[i] = halfs[bytes[2 * i] | (bytes[2 * i + 1] << 8)] * image.scale;
  return values;
}

export const luminance = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
