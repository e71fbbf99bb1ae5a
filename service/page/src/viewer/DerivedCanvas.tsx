// A body that was made of a fit, to be turned; it is fetched when it is asked for.
import { useEffect, useRef, useState } from "preact/hooks";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { ProblemNote } from "../ui/ProblemNote";
import type { DerivedScene } from "./DerivedScene";
import { readGlb } from "./glb";
import type { GlbBody } from "./glb";
import { MotionBar } from "./MotionBar";
import { lengthOf, readMotion } from "./motion";
import type { Side } from "./Turntable";

interface Props {
  readonly path: string;
  readonly label: string;
  /** The fit's own bodies, where this one stands as the posed one does: it is seen from its front. */
  readonly like?: { readonly posed: GlbBody; readonly canonical: GlbBody | null };
  /** Whether it turns by itself until somebody turns it; not for those who want calm. */
  readonly turns?: boolean;
  /** To be looked at alone. */
  readonly small?: boolean;
  /** From where it is to be looked at, anew with each object. */
  readonly from?: { readonly side: Side } | null;
}

export function DerivedCanvas({ path, label, like, turns = false, small = false, from = null }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<DerivedScene | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [failed, setFailed] = useState(false);
  const [moving, setMoving] = useState<{ readonly scene: DerivedScene; readonly length: number } | null>(null);

  useEffect(() => {
    const target = canvas.current!;
    let gone = false;
    const observer = new ResizeObserver(([entry]) => {
      scene.current?.resize(entry!.contentRect.width, entry!.contentRect.height);
    });
    const open = async () => {
      const [file, { DerivedScene }, { facingOf }] = await Promise.all([getFile(path), import("./DerivedScene"), import("./facing")]);
      const content = await file.arrayBuffer();
      const body = readGlb(content);
      const motion = readMotion(content);
      const image = body.texture && (await createImageBitmap(body.texture));
      if (gone) return image?.close();
      const facing = like ? facingOf(like.posed, like.canonical) : 0;
      try {
        scene.current = new DerivedScene(target, body, image, { azimuth: facing, facing, stands: !like || like.posed.upright !== null });
        if (motion) scene.current.take(motion);
        observer.observe(target);
      } catch {
        return setFailed(true);
      }
      if (motion) setMoving({ scene: scene.current, length: lengthOf(motion) });
      if (turns && !matchMedia("(prefers-reduced-motion: reduce)").matches) scene.current.turnByItself();
    };
    open().catch((error) => gone || setProblem(problemFrom(error)));
    return () => {
      gone = true;
      observer.disconnect();
      scene.current?.dispose();
      scene.current = null;
    };
  }, [path]);
  useEffect(() => {
    if (from) scene.current?.lookAtSide(from.side);
  }, [from]);

  if (problem) return small ? null : <ProblemNote problem={problem} />;
  if (failed) return small ? null : <p class="note is-problem">{messages.look.noWebglToTurn}</p>;
  if (small) return <canvas ref={canvas} aria-hidden="true" />;
  return (
    <>
      <canvas
        ref={canvas}
        class="derived-canvas"
        tabIndex={0}
        role="img"
        aria-label={messages.look.derived(label)}
        onKeyDown={(event) => {
          if (scene.current?.turnBy(event.key)) event.preventDefault();
        }}
      />
      {moving && <MotionBar {...moving} />}
    </>
  );
}
