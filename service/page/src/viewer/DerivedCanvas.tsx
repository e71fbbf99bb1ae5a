// A body that was made of a fit, to be turned; it is fetched when it is asked for.
import { useEffect, useRef, useState } from "preact/hooks";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { ProblemNote } from "../ui/ProblemNote";
import type { DerivedScene } from "./DerivedScene";
import { dressed, readGlb } from "./glb";
import type { GlbBody } from "./glb";
import { MotionBar } from "./MotionBar";
import { lengthOf, readMotion } from "./motion";
import type { Side } from "./Turntable";

/** A picture of what is seen, of that height in pixels; as large as it is seen unless one is given. */
export type Snapshot = (height?: number) => HTMLCanvasElement | undefined;

interface Props {
  readonly path: string;
  /** Of the body in its colours, which one wears that has none. */
  readonly skin?: string | null;
  readonly label: string;
  /** The fit's own bodies, where this one stands as the posed one does: it is seen from its front. */
  readonly like?: { readonly posed: GlbBody; readonly canonical: GlbBody | null };
  /** Whether it turns once by itself; not for those who want calm. */
  readonly turns?: boolean;
  /** Whether it comes out of the picture below it first. */
  readonly emerges?: boolean;
  /** It is seen, and pictures of it can be taken. */
  readonly onSeen?: (take: Snapshot) => void;
  /** To be looked at alone. */
  readonly small?: boolean;
  /** From where it is to be looked at, anew with each object. */
  readonly from?: { readonly side: Side } | null;
}

export function DerivedCanvas({ path, skin = null, label, like, turns = false, emerges = false, small = false, from = null, onSeen }: Props) {
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
      const plain = readGlb(content);
      const body = plain.texture || !skin ? plain : dressed(plain, readGlb(await (await getFile(skin)).arrayBuffer()));
      const motion = readMotion(content);
      const image = body.texture && (await createImageBitmap(body.texture));
      if (gone) return image?.close();
      const facing = like ? facingOf(like.posed, like.canonical) : 0;
      try {
        scene.current = new DerivedScene(target, body, image, { azimuth: like ? null : facing, facing, stands: !like || like.posed.upright !== null });
        if (motion) scene.current.take(motion);
        observer.observe(target);
      } catch {
        return setFailed(true);
      }
      if (motion) setMoving({ scene: scene.current, length: lengthOf(motion) });
      const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
      if (emerges && !isCalm && like?.posed.camera) scene.current.emerge(like.posed.camera);
      else if (turns && !isCalm) scene.current.turnOnce();
      // It has its size in the next frame, and is drawn.
      requestAnimationFrame(() => requestAnimationFrame(() => gone || onSeen?.((height) => scene.current?.seen(height))));
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
