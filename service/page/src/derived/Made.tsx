// One thing made of a fit: where it stands, what came out, its files.
import { useState } from "preact/hooks";
import type { Derivation } from "../api/types";
import { isActive } from "../fit/watch";
import { FileButton } from "../result/FileButton";
import { usePictureOf } from "../result/files";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { kindLabel, kindOf } from "./kinds";
import type { Shows } from "./kinds";
import { Told } from "./Told";

export function Made({ made, onErase }: { made: Derivation; onErase: () => void }) {
  const label = kindLabel(made.kind);
  const done = made.state === "succeeded";
  const files = Object.entries(made.links.artifacts ?? {}).filter(([name]) => name !== "result.json");
  return (
    <li>
      <header class="section-head">
        <h3>{label}</h3>
        <IconButton icon="trash" label={`Delete: ${label.toLowerCase()}`} onClick={onErase} />
      </header>
      {isActive(made) && <progress class="bar" max={1} value={made.progress} aria-label={`Progress: ${label.toLowerCase()}`} />}
      {made.problem && <ProblemNote problem={made.problem} />}
      {done && kindOf(made.kind)?.pictures.map((shows) => <Shown key={shows.file} made={made} shows={shows} />)}
      {done && <Told made={made} />}
      {files.length > 0 && (
        <ul class="downloads">
          {files.map(([name, path]) => (
            <li key={name}>
              <FileButton name={name} path={path} />
            </li>
          ))}
        </ul>
      )}
    </li>
  );
}

/** A picture of what came out; one that moves can be held still, and is for those who want calm. */
function Shown({ made, shows: { file, still, alt, caption } }: { made: Derivation; shows: Shows }) {
  const [held, hold] = useState(() => matchMedia("(prefers-reduced-motion: reduce)").matches);
  const url = usePictureOf(made, still && held ? still : file, true);
  return (
    <figure>
      {url && <img src={url} alt={alt} />}
      {caption && <figcaption class="fine">{caption}</figcaption>}
      {still && (
        <button class="button is-small" type="button" onClick={() => hold(!held)}>
          {held ? "Play" : "Hold still"}
        </button>
      )}
    </figure>
  );
}
