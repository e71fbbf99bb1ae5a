// Nearer, farther, the whole picture, and the whole screen for it.
import { messages } from "../messages";
import { IconButton } from "../ui/IconButton";
import { isFull } from "./full";
import type { PictureView } from "./pictureView";

const BUTTON_ZOOM = 1.5;

export function ViewButtons({ of: { zoom, whole } }: { of: PictureView }) {
  const { stage } = messages;
  const full = isFull.value;
  return (
    <>
      <IconButton icon="minus" label={stage.zoomOut} onClick={() => zoom(1 / BUTTON_ZOOM)} />
      <IconButton icon="frame" label={stage.whole} onClick={whole} />
      <IconButton icon="plus" label={stage.zoomIn} onClick={() => zoom(BUTTON_ZOOM)} />
      <span class={`full-button ${full ? "is-full" : ""}`}>
        <IconButton icon={full ? "close" : "full"} label={full ? stage.leaveFull : stage.full} onClick={() => (isFull.value = !full)} />
      </span>
    </>
  );
}
