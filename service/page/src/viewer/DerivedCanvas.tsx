// A body that was made of a fit, to be turned; it is fetched when it is asked for.
import { useEffect, useRef, useState } from "preact/hooks";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { messages } from "../messages/language";
import { ProblemNote } from "../ui/ProblemNote";
import type { DerivedScene } from "./DerivedScene";
import { readGlb } from "./glb";

export function DerivedCanvas({ path, label }: { path: string; label: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const scene = useRef<DerivedScene | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [failed, setFailed] = useState(false);

  useEffect(() => {
    const target = canvas.current!;
    let gone = false;
    const observer = new ResizeObserver(([entry]) => {
      scene.current?.resize(entry!.contentRect.width, entry!.contentRect.height);
    });
    const open = async () => {
      const [file, { DerivedScene }] = await Promise.all([getFile(path), import("./DerivedScene")]);
      const body = readGlb(await file.arrayBuffer());
      const image = body.texture && (await createImageBitmap(body.texture));
      if (gone) return;
      try {
        scene.current = new DerivedScene(target, body, image);
        observer.observe(target);
      } catch {
        setFailed(true);
      }
    };
    open().catch((error) => gone || setProblem(problemFrom(error)));
    return () => {
      gone = true;
      observer.disconnect();
      scene.current?.dispose();
      scene.current = null;
    };
  }, [path]);

  if (problem) return <ProblemNote problem={problem} />;
  if (failed) return <p class="note is-problem">{messages.value.look.noWebglToTurn}</p>;
  return (
    <canvas
      ref={canvas}
      class="derived-canvas"
      tabIndex={0}
      role="img"
      aria-label={messages.value.look.derived(label)}
      onKeyDown={(event) => {
        if (scene.current?.turnBy(event.key)) event.preventDefault();
      }}
    />
  );
}
