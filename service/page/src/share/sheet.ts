// What pictures to share are drawn on; they look the same whatever the page's theme.

export const GROUND = "#efebe6";

export interface Sheet {
  readonly canvas: HTMLCanvasElement;
  readonly context: CanvasRenderingContext2D;
}

export function sheetOf(width: number, height: number): Sheet {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d")!;
  context.imageSmoothingQuality = "high";
  context.fillStyle = GROUND;
  context.fillRect(0, 0, width, height);
  return { canvas, context };
}

export async function pngOf({ canvas }: Sheet, name: string): Promise<File> {
  const content = await new Promise<Blob>((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error(name)))));
  return new File([content], `${name}.png`, { type: "image/png" });
}
