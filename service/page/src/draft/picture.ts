// A picture from a file, the clipboard or a camera, as this browser shows it.

export interface Picture {
  readonly name: string;
  /** What is uploaded. */
  readonly file: Blob;
  readonly url: string;
  readonly element: HTMLImageElement;
  readonly width: number;
  readonly height: number;
}

const ACCEPTED = ["image/jpeg", "image/png", "image/webp"];
const CONVERTED_QUALITY = 0.95;

/** Raises an Error that says what to do where the browser cannot show the file. */
export async function openPicture(file: Blob, name: string): Promise<Picture> {
  const shown = await shownPicture(file, name);
  if (ACCEPTED.includes(file.type)) return shown;
  // Another kind this browser knows (HEIC, AVIF ...): its pixels, as a JPEG.
  const converted = await asJpeg(shown.element);
  URL.revokeObjectURL(shown.url);
  return shownPicture(converted, name);
}

async function shownPicture(file: Blob, name: string): Promise<Picture> {
  const url = URL.createObjectURL(file);
  const element = new Image();
  element.src = url;
  try {
    await element.decode();
  } catch {
    URL.revokeObjectURL(url);
    throw new Error(`${name} is not a picture this browser can show. Take a JPEG, PNG or WebP.`);
  }
  return { name, file, url, element, width: element.naturalWidth, height: element.naturalHeight };
}

async function asJpeg(element: HTMLImageElement): Promise<Blob> {
  const canvas = document.createElement("canvas");
  canvas.width = element.naturalWidth;
  canvas.height = element.naturalHeight;
  const context = canvas.getContext("2d")!;
  context.fillStyle = "white";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(element, 0, 0);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture cannot be converted."))), "image/jpeg", CONVERTED_QUALITY),
  );
}
