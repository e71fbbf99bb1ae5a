// Whether a picture's file reaches its end: browsers show what there is of one that was cut off, and say nothing.
// Sources: ITU-T T.81 annex B (JPEG), the PNG specification section 5, the WebP container specification.

export type Kind = "jpeg" | "png" | "webp" | "heic";

const HEIC_BRANDS = ["heic", "heix", "heim", "heis"];
const END = 0xd9;

/** By its first bytes; null for another kind. */
export function kindOf(bytes: Uint8Array): Kind | null {
  if (bytes[0] === 0xff && bytes[1] === 0xd8) return "jpeg";
  if (text(bytes, 1, 4) === "PNG") return "png";
  if (text(bytes, 0, 4) === "RIFF" && text(bytes, 8, 12) === "WEBP") return "webp";
  if (text(bytes, 4, 8) !== "ftyp") return null;
  // The main brand, and those it is compatible with; between them stands a version.
  const brands = text(bytes, 8, Math.min(uint32(bytes, 0), 400)).match(/.{4}/gs) ?? [];
  return brands.some((brand) => HEIC_BRANDS.includes(brand)) ? "heic" : null;
}

export function isWhole(bytes: Uint8Array, kind: Kind | null): boolean {
  if (kind === "jpeg") return jpegEnds(bytes);
  if (kind === "png") return pngEnds(bytes);
  return kind !== "webp" || 8 + uint32(bytes, 4, true) <= bytes.length;
}

/** Pictures within it, such as a thumbnail, lie in segments and are not looked into. */
function jpegEnds(bytes: Uint8Array): boolean {
  for (const { marker } of jpegSegments(bytes)) {
    if (marker === END) return true;
  }
  return false;
}

/** Each marker with the place and length of what belongs to it. */
export function* jpegSegments(bytes: Uint8Array): Generator<{ marker: number; start: number; length: number }> {
  let at = 2;
  for (;;) {
    // What was coded may hold an FF, which a zero or a restart follows.
    do at = bytes.indexOf(0xff, at) + 1;
    while (at > 0 && isData(bytes[at]));
    const marker = bytes[at];
    if (at === 0 || marker === undefined) return;
    const length = marker === END ? 0 : uint16(bytes, at + 1);
    yield { marker, start: at + 3, length: Math.max(0, length - 2) };
    if (marker === END) return;
    at += 1 + length;
  }
}

function isData(after: number | undefined): boolean {
  return after === 0 || after === 0xff || after === 1 || (after !== undefined && after >= 0xd0 && after < END);
}

function pngEnds(bytes: Uint8Array): boolean {
  for (let at = 8; at + 12 <= bytes.length; at += 12 + uint32(bytes, at)) {
    if (text(bytes, at + 4, at + 8) === "IEND") return true;
  }
  return false;
}

function text(bytes: Uint8Array, from: number, to: number): string {
  return String.fromCharCode(...bytes.subarray(from, to));
}

function uint16(bytes: Uint8Array, at: number): number {
  return ((bytes[at] ?? 0) << 8) | (bytes[at + 1] ?? 0);
}

function uint32(bytes: Uint8Array, at: number, little = false): number {
  return bytes.length < at + 4 ? 0 : new DataView(bytes.buffer, bytes.byteOffset).getUint32(at, little);
}
