// The mask over the picture: an outline, with a tint where nothing else is shown.
import { useEffect, useRef } from "preact/hooks";
import type { Size, View } from "../stage/view";
import { showMask } from "./canvas";
import type { DrawnMask } from "./canvas";

interface Props {
  readonly mask: DrawnMask;
  readonly view: View;
  readonly size: Size;
  readonly label: string;
  readonly isTinted?: boolean;
  /** How often brushes have drawn on the mask: it is shown anew. */
  readonly drawn?: number;
}

export function MaskLayer({ mask, view, size, label, isTinted = true, drawn = 0 }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    if (size.width === 0) return undefined;
    const frame = requestAnimationFrame(() => {
      // The picture may have been put away meanwhile.
      if (canvas.current) showMask(canvas.current, mask, view, size, isTinted);
    });
    return () => cancelAnimationFrame(frame);
  }, [mask, view, size, isTinted, drawn]);
  return <canvas class="mask-layer" ref={canvas} role="img" aria-label={label} />;
}
