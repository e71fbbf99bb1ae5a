// The lens that a camera wrote into a JPEG, and the same in a JPEG that a canvas wrote, which has none.
// Source: CIPA DC-008 (Exif 2.32) 4.5 and 4.6.
import { jpegSegments } from "./whole";

const APP1 = 0xe1;
const EXIF_MARK = [0x45, 0x78, 0x69, 0x66, 0, 0] as const;
const EXIF_DIRECTORY = 0x8769;
const FOCAL_LENGTH_IN_35MM_FILM = 0xa405;
const ENTRY_BYTES = 12;
const SHORT = 3;
const LONG = 4;

/** Millimetres; null where there is none, or the block is damaged. */
export function focalLength35mm(bytes: Uint8Array): number | null {
  for (const { marker, start, length } of jpegSegments(bytes)) {
    if (marker !== APP1 || !EXIF_MARK.every((byte, i) => bytes[start + i] === byte)) continue;
    const tiff = new DataView(bytes.buffer, bytes.byteOffset + start + EXIF_MARK.length, length - EXIF_MARK.length);
    try {
      return readLens(tiff);
    } catch {
      return null;
    }
  }
  return null;
}

/** A JPEG with a block that names the lens and nothing else. */
export function withFocalLength(jpeg: Blob, mm: number): Blob {
  const block = new DataView(new ArrayBuffer(56));
  const numbers = [0xff, 0xd8, 0xff, APP1, 0, 52, ...EXIF_MARK];
  numbers.forEach((byte, i) => block.setUint8(i, byte));
  const tiff = new DataView(block.buffer, numbers.length);
  tiff.setUint32(0, 0x4d4d002a);
  tiff.setUint32(4, 8);
  entry(tiff, 8, EXIF_DIRECTORY, LONG);
  tiff.setUint32(18, 26);
  entry(tiff, 26, FOCAL_LENGTH_IN_35MM_FILM, SHORT);
  tiff.setUint16(36, Math.round(mm));
  return new Blob([block.buffer, jpeg.slice(2)], { type: jpeg.type });
}

/** A directory of one entry, whose value stands ten bytes on. */
function entry(tiff: DataView, at: number, tag: number, type: number): void {
  tiff.setUint16(at, 1);
  tiff.setUint16(at + 2, tag);
  tiff.setUint16(at + 4, type);
  tiff.setUint32(at + 6, 1);
}

function readLens(tiff: DataView): number | null {
  const little = tiff.getUint16(0) === 0x4949;
  const find = (directory: number, tag: number) => {
    const count = tiff.getUint16(directory, little);
    for (let at = directory + 2; at < directory + 2 + count * ENTRY_BYTES; at += ENTRY_BYTES) {
      if (tiff.getUint16(at, little) === tag) return at;
    }
    return null;
  };
  const pointer = find(tiff.getUint32(4, little), EXIF_DIRECTORY);
  const lens = pointer === null ? null : find(tiff.getUint32(pointer + 8, little), FOCAL_LENGTH_IN_35MM_FILM);
  if (lens === null) return null;
  const isLong = tiff.getUint16(lens + 2, little) === LONG;
  const mm = isLong ? tiff.getUint32(lens + 8, little) : tiff.getUint16(lens + 8, little);
  return mm > 0 ? mm : null;
}
