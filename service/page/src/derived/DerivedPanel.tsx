// What can be made of a finished fit: asked for, followed, looked at and kept.
import { useState } from "preact/hooks";
import type { Derivation, DerivationKind, Job, NamedPose } from "../api/types";
import { isActive } from "../fit/watch";
import { usePictureOf } from "../result/files";
import { FileButton } from "../result/FileButton";
import { Choice } from "../ui/Choice";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { FACTORS, FIRST_WISHES, KINDS, POSES, kindLabel } from "./kinds";
import { useDerivations } from "./follow";

export function DerivedPanel({ fit }: { fit: Job }) {
  const { list, problem, start, erase } = useDerivations(fit);
  const [kind, setKind] = useState<DerivationKind>("report");
  const [wishes, wish] = useState(FIRST_WISHES);
  const [asking, setAsking] = useState(false);
  const chosen = KINDS[kind]!;
  return (
    <section class="section" aria-labelledby="derived-title">
      <h2 id="derived-title">Make something of it</h2>
      <Choice
        name="derivation"
        legend="What to make"
        quiet
        options={(Object.keys(KINDS) as DerivationKind[]).map((value) => ({ value, label: kindLabel(value) }))}
        value={kind}
        onChange={setKind}
      />
      <p class="fine">{chosen.help}</p>
      {kind === "caricature" && (
        <label class="slider">
          <span>Times</span>
          <input
            type="range"
            min={FACTORS.least}
            max={FACTORS.most}
            step={FACTORS.step}
            value={wishes.factor}
            onInput={(event) => wish({ ...wishes, factor: Number(event.currentTarget.value) })}
          />
          <output>{wishes.factor}</output>
        </label>
      )}
      {kind === "pose" && (
        <div class="field">
          <label for="pose">Pose</label>
          <select
            id="pose"
            value={wishes.pose}
            onChange={(event) => wish({ ...wishes, pose: event.currentTarget.value as NamedPose })}
          >
            {POSES.map(({ value, label }) => (
              <option key={value} value={value}>
                {label}
              </option>
            ))}
          </select>
        </div>
      )}
      <button
        class="button"
        type="button"
        disabled={asking}
        onClick={() => {
          setAsking(true);
          void start(chosen.request(wishes)).finally(() => setAsking(false));
        }}
      >
        Make the {chosen.label.toLowerCase()}
      </button>
      {problem && <ProblemNote problem={problem} />}
      <ul class="derived">
        {list.map((each) => (
          <Made key={each.id} made={each} onErase={() => void erase(each)} />
        ))}
      </ul>
    </section>
  );
}

function Made({ made, onErase }: { made: Derivation; onErase: () => void }) {
  const label = kindLabel(made.kind);
  const shows = KINDS[made.kind]?.picture ?? null;
  const picture = usePictureOf(made, shows ?? "", shows !== null && made.state === "succeeded");
  const files = Object.entries(made.links.artifacts ?? {}).filter(([name]) => name !== "result.json");
  return (
    <li>
      <header class="section-head">
        <h3>{label}</h3>
        <IconButton icon="trash" label={`Delete: ${label.toLowerCase()}`} onClick={onErase} />
      </header>
      {isActive(made) && <progress class="bar" max={1} value={made.progress} aria-label={`Progress: ${label.toLowerCase()}`} />}
      {made.problem && <ProblemNote problem={made.problem} />}
      {picture && <img src={picture} alt={`${label} of the body`} />}
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
