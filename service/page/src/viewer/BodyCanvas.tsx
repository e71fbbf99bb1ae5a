// The WebGL canvas as a component; three.js is loaded with it, not with the page.
import { useEffect, useRef } from "preact/hooks";
import type { Cues } from "../api/types";
import type { BodyScene, Placement, PosedAndUpright } from "./BodyScene";
import type { GlbBody } from "./glb";
import type { Surface } from "./surface";
import type { TapeLines } from "./Tapes";

interface Props {
  readonly posed: GlbBody;
  readonly canonical: GlbBody | null;
  /** The same before shading, once there; shown where `body` is SE. */
  readonly outlined: PosedAndUpright | null;
  readonly body: Cues;
  readonly picture: HTMLImageElement;
  readonly tapes: TapeLines;
  /** The measurement whose tape stands out. */
  readonly marked: string | null;
  readonly placement: Placement;
  readonly surface: Surface;
  readonly opacity: number;
  readonly onFailure: () => void;
}

export function BodyCanvas(props: Props) {
  const { posed, canonical, outlined, body, picture, tapes, marked, placement, surface, opacity, onFailure } = props;
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<BodyScene | null>(null);
  const wanted = useRef({ placement, surface, outlined, body });
  wanted.current = { placement, surface, outlined, body };

  useEffect(() => {
    const target = canvas.current!;
    let gone = false;
    const observer = new ResizeObserver(([entry]) => {
      scene.current?.resize(entry!.contentRect.width, entry!.contentRect.height);
    });
    void import("./BodyScene").then(({ BodyScene }) => {
      if (gone) return;
      try {
        scene.current = new BodyScene(target, posed, canonical, picture, tapes);
      } catch {
        return onFailure();
      }
      scene.current.place(wanted.current.placement);
      scene.current.compareWith(wanted.current.outlined);
      scene.current.show(wanted.current.body);
      scene.current.surface(wanted.current.surface);
      observer.observe(target);
    }, onFailure);
    return () => {
      gone = true;
      observer.disconnect();
      scene.current?.dispose();
      scene.current = null;
    };
  }, [posed, canonical, picture, tapes]);

  useEffect(() => scene.current?.place(placement), [placement]);
  useEffect(() => {
    scene.current?.compareWith(outlined);
    scene.current?.show(body);
    scene.current?.surface(surface);
  }, [outlined, body, surface]);
  useEffect(() => scene.current?.mark(marked), [marked]);

  const turned = placement !== "picture";
  return (
    <canvas
      ref={canvas}
      class="body-canvas"
      style={{ opacity }}
      tabIndex={turned ? 0 : -1}
      role="img"
      aria-label={turned ? "The body in 3D; arrow keys turn it" : "The body over the picture"}
      onKeyDown={(event) => {
        if (scene.current?.turnBy(event.key)) event.preventDefault();
      }}
    />
  );
}
