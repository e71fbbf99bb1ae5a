// The WebGL canvas as a component; three.js is loaded with it, not with the page.
import { useEffect, useRef } from "preact/hooks";
import type { Flips, TurnedLimb } from "../flip/flips";
import { messages } from "../messages";
import type { BodyScene, Placement } from "./BodyScene";
import type { GlbBody } from "./glb";
import type { Surface } from "./surface";
import type { TapeEnds, TapeLines } from "./Tapes";
import type { Side } from "./Turntable";

interface Props {
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  readonly tapes: TapeLines;
  /** The measurement whose tape stands out. */
  readonly marked: string | null;
  readonly placement: Placement;
  readonly surface: Surface;
  readonly opacity: number;
  /** From where it is to be looked at, anew with each object; null leaves the view as it is. */
  readonly from: { readonly side: Side } | null;
  /** Where the tapes lie on the canvas. */
  readonly onTapes: (ends: readonly TapeEnds[]) => void;
  /** The upright body as it would be; null as it is. */
  readonly other: GlbBody | null;
  /** Limbs that are seen turned the other way. */
  readonly flips: Flips;
  /** The limb that stands out. */
  readonly limb: TurnedLimb | null;
  readonly onPointLimb: (limb: TurnedLimb | null) => void;
  readonly onFlip: (limb: TurnedLimb) => void;
  readonly onFailure: () => void;
}

/** Farther than this a pointer was dragged, and has clicked nothing. */
const CLICK_WITHIN_PX = 5;

export function BodyCanvas(props: Props) {
  const { posed, canonical, tapes, marked, placement, surface, opacity, from, onTapes, other, flips, limb, onPointLimb, onFlip, onFailure } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<BodyScene | null>(null);
  const wanted = useRef({ placement, surface, marked, flips, limb });
  wanted.current = { placement, surface, marked, flips, limb };
  const pressed = useRef({ x: 0, y: 0 });

  useEffect(() => {
    const target = canvas.current!;
    let gone = false;
    const observer = new ResizeObserver(([entry]) => {
      scene.current?.resize(entry!.contentRect.width, entry!.contentRect.height);
    });
    void import("./BodyScene").then(({ BodyScene }) => {
      if (gone) return;
      try {
        scene.current = new BodyScene(target, posed, canonical, tapes);
      } catch {
        return onFailure();
      }
      scene.current.place(wanted.current.placement);
      scene.current.surface(wanted.current.surface);
      scene.current.mark(wanted.current.marked);
      scene.current.followTapes(onTapes);
      observer.observe(target);
      void takeLimbs(scene.current);
    }, onFailure);
    return () => {
      gone = true;
      observer.disconnect();
      scene.current?.dispose();
      scene.current = null;
    };
  }, [posed, canonical, tapes]);

  const takeLimbs = async (made: BodyScene) => {
    const tools = await import("../flip/limbs").catch(() => null);
    if (!tools || scene.current !== made) return;
    made.turnLimbs(wanted.current.flips);
    made.markLimb(wanted.current.limb);
    made.useLimbs(tools);
  };

  useEffect(() => scene.current?.place(placement), [placement]);
  useEffect(() => scene.current?.surface(surface), [surface]);
  useEffect(() => scene.current?.mark(marked), [marked]);
  useEffect(() => scene.current?.shapeUpright(other), [other]);
  useEffect(() => scene.current?.turnLimbs(flips), [flips]);
  useEffect(() => scene.current?.markLimb(limb), [limb]);
  useEffect(() => {
    if (from) scene.current?.lookFrom(from.side);
  }, [from]);

  const turned = placement !== "picture";
  return (
    <canvas
      ref={canvas}
      class="body-canvas"
      style={limb ? { opacity, cursor: "pointer" } : { opacity }}
      tabIndex={turned ? 0 : -1}
      role="img"
      aria-label={turned ? messages.look.turned : messages.look.over}
      onPointerDown={({ clientX: x, clientY: y }) => (pressed.current = { x, y })}
      onPointerMove={({ clientX, clientY, pointerType, buttons }) => {
        // A finger points at nothing before it taps, and a body that is being turned is not pointed at.
        if (pointerType !== "touch" && buttons === 0) onPointLimb(scene.current?.limbAt(clientX, clientY) ?? null);
      }}
      onPointerLeave={() => onPointLimb(null)}
      onClick={({ clientX, clientY }) => {
        const { x, y } = pressed.current;
        if (Math.hypot(clientX - x, clientY - y) > CLICK_WITHIN_PX) return;
        const found = scene.current?.limbAt(clientX, clientY);
        if (found) onFlip(found);
      }}
      onKeyDown={(event) => {
        if (scene.current?.turnBy(event.key)) event.preventDefault();
      }}
    />
  );
}
