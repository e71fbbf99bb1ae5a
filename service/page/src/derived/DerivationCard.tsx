// One thing made of a fit: where it stands, what came out, its files.
import { useState } from "preact/hooks";
import type { Derivation } from "../api/types";
import { isActive } from "../fit/watch";
import { FileButton } from "../result/FileButton";
import { tableOf, usePictureOf } from "../result/files";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { kindLabel, kindOf } from "./kinds";
import type { Kind, Shows } from "./kinds/kind";
import { DerivationSummary } from "./DerivationSummary";

interface Props {
  readonly made: Derivation;
  readonly onRetry: () => void;
  readonly onErase: () => void;
}

export function DerivationCard({ made, onRetry, onErase }: Props) {
  const label = kindLabel(made.kind);
  const done = made.state === "succeeded";
  const kind = kindOf(made.kind);
  const files = Object.entries(made.links.artifacts ?? {}).filter(([name]) => name !== "result.json");
  if (done && kind?.hasTable) files.push(tableOf(made));
  return (
    <li>
      <header class="section-head">
        <h3>{label}</h3>
        <IconButton icon="trash" label={`Delete: ${label.toLowerCase()}`} onClick={onErase} />
      </header>
      {isActive(made) && <progress class="bar" max={1} value={made.progress} aria-label={`Progress: ${label.toLowerCase()}`} />}
      {made.problem && <ProblemNote problem={made.problem} />}
      {made.links.retry && !done && (
        <button class="button is-small" type="button" onClick={onRetry}>
          Try again
        </button>
      )}
      {done && kind && picturesOf(kind, files.map(([name]) => name)).map((shows) => <Shown key={shows.file} made={made} shows={shows} />)}
      {done && <Turned made={made} />}
      {done && <DerivationSummary made={made} />}
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

function picturesOf({ pictures, pictureOf }: Pick<Kind, "pictures" | "pictureOf">, names: readonly string[]): readonly Shows[] {
  return [...pictures, ...names.map((name) => pictureOf?.(name) ?? null).filter((shows) => shows !== null)];
}

/** The body that came out, in 3D for those who ask for it. */
function Turned({ made }: { made: Derivation }) {
  const [opened, open] = useState(false);
  const turns = kindOf(made.kind)?.turns;
  const path = turns && made.links.artifacts?.[turns.file];
  if (!turns || !path) return null;
  if (opened) return <DerivedCanvas path={path} label={turns.label} />;
  return (
    <button class="button is-small" type="button" onClick={() => open(true)}>
      Turn it
    </button>
  );
}

/** A picture of what came out; one that moves can be held still, and is for those who want calm. */
function Shown({ made, shows: { file, still, alt, caption } }: { made: Derivation; shows: Shows }) {
  const [held, hold] = useState(() => matchMedia("(prefers-reduced-motion: reduce)").matches);
  // The room of the first one shown: nothing below moves when another takes its place.
  const [ratio, setRatio] = useState<string | null>(null);
  const wanted = still && held ? still : file;
  const url = usePictureOf(made, wanted, true);
  return (
    <figure>
      <div class="derived-picture" style={ratio ? { aspectRatio: ratio } : {}}>
        {url && (
          <img
            key={url}
            src={url}
            alt={alt}
            onLoad={({ currentTarget: image }) => {
              image.dataset.shows = wanted;
              setRatio((known) => known ?? `${image.naturalWidth} / ${image.naturalHeight}`);
            }}
          />
        )}
      </div>
      {caption && <figcaption class="fine">{caption}</figcaption>}
      {still && (
        <button class="button is-small" type="button" onClick={() => hold(!held)}>
          {held ? "Play" : "Hold still"}
        </button>
      )}
    </figure>
  );
}
