// The border of what was taken for the person, drawn over the picture.
import { useEffect, useRef } from "preact/hooks";

const INSIDE = 128;
const COLOUR = [255, 196, 0, 255] as const;

export function MaskOutline({ url, label }: { url: string; label: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const image = new Image();
    let isCurrent = true;
    image.src = url;
    image.decode().then(
      () => isCurrent && canvas.current && draw(canvas.current, image),
      () => undefined,
    );
    return () => {
      isCurrent = false;
    };
  }, [url]);
  return <canvas class="mask-outline" ref={canvas} role="img" aria-label={label} />;
}

function draw(canvas: HTMLCanvasElement, image: HTMLImageElement): void {
  const width = (canvas.width = image.naturalWidth);
  const height = (canvas.height = image.naturalHeight);
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, width, height);
  const inside = new Uint8Array(width * height);
  for (let i = 0; i < inside.length; i++) inside[i] = pixels.data[4 * i]! >= INSIDE ? 1 : 0;
  pixels.data.fill(0);
  for (let row = 1; row < height - 1; row++) {
    for (let column = 1; column < width - 1; column++) {
      const at = row * width + column;
      const isBorder =
        inside[at] &&
        !(inside[at - 1]! & inside[at + 1]! & inside[at - width]! & inside[at + width]!);
      if (!isBorder) continue;
      for (const place of [at, at - 1, at + 1, at - width, at + width]) pixels.data.set(COLOUR, 4 * place);
    }
  }
  context.putImageData(pixels, 0, 0);
}
