import type { PictureView } from "./pictureView";

/** Beyond this the picture's own pixels are seen. */
const PIXELS_FROM = 3;

export function StagePicture({ of: { picture, view } }: { of: PictureView }) {
  const { scale, x, y } = view.value;
  return (
    <img
      class={`stage-picture ${scale > PIXELS_FROM ? "is-pixelated" : ""}`}
      src={picture.url}
      alt=""
      draggable={false}
      width={picture.width}
      height={picture.height}
      style={{ transform: `translate(${x}px, ${y}px) scale(${scale})` }}
    />
  );
}
