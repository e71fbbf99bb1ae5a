// The body from its right side, small, beside the picture that shows it from where the camera stood.
import { useEffect, useRef } from "preact/hooks";
import { isEmpty } from "../flip/flips";
import type { Flips } from "../flip/flips";
import { messages } from "../messages";
import type { DerivedScene } from "./DerivedScene";
import type { GlbBody } from "./glb";

interface Props {
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  /** Limbs that are seen turned the other way. */
  readonly flips: Flips;
}

export function SideView({ posed, canonical, flips }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const shown = useRef<DerivedScene | null>(null);
  const wanted = useRef(flips);
  wanted.current = flips;
  const reshape = () => void reshaped(shown, posed, wanted);
  useEffect(() => {
    let scene: DerivedScene | null = null;
    let gone = false;
    const observer = new ResizeObserver(([entry]) => scene?.resize(entry!.contentRect.width, entry!.contentRect.height));
    Promise.all([import("./DerivedScene"), import("./facing"), import("./Turntable")]).then(
      ([{ DerivedScene }, { facingOf }, { SIDES }]) => {
        if (gone) return;
        const facing = facingOf(posed, canonical);
        scene = new DerivedScene(canvas.current!, posed, null, { azimuth: facing + SIDES.side, facing, stands: false });
        observer.observe(canvas.current!);
        shown.current = scene;
        if (!isEmpty(wanted.current)) reshape();
      },
      // Without WebGL the large view says so.
    ).catch(() => undefined);
    return () => {
      gone = true;
      observer.disconnect();
      scene?.dispose();
      shown.current = null;
    };
  }, [posed, canonical]);
  useEffect(reshape, [flips]);
  const { look } = messages;
  return (
    <figure class="side-view">
      <canvas ref={canvas} role="img" aria-label={look.fromSide} />
      <figcaption class="fine">{look.side}</figcaption>
    </figure>
  );
}

async function reshaped(shown: { current: DerivedScene | null }, posed: GlbBody, flips: { current: Flips }): Promise<void> {
  if (!shown.current) return;
  const tools = await import("../flip/limbs").catch(() => null);
  shown.current?.reshape(tools?.bent(posed, flips.current) ?? posed);
}
