// A fit on its way: its stages, which picture they are at, and its energies as they go down.
import { useState } from "preact/hooks";
import { getAsked } from "../api/calls";
import { isCutOff } from "../api/connection";
import type { Fit } from "../api/fits";
import type { Picture } from "../draft/picture";
import { assumed } from "../history/store";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { Icon } from "../ui/Icon";
import { useAsked } from "../ui/asked";
import { EnergyChart } from "./EnergyChart";
import { STAGES } from "./stages";
import { readings } from "./watch";

interface Props {
  readonly fit: Fit;
  readonly pictures: readonly Picture[];
  /** Whether the service was told. */
  readonly cancel: () => Promise<boolean>;
}

export function Progress({ fit, pictures, cancel }: Props) {
  const { fit: words } = messages;
  const [stopping, setStopping] = useState(fit.cancel_requested);
  const asked = useAsked(fit.id, () => getAsked(fit));
  const list = readings.value[fit.id] ?? [];
  const at = STAGES.findIndex((stage) => stage === fit.stage);
  const isOfSeveral = fit.pictures.length > 1;
  return (
    <main class="bench">
      <div class="bench-stage is-quiet">
        {isOfSeveral ? (
          <ul class="fit-pictures">
            {pictures.map(({ url }, number) => (
              <li key={url} class={fit.view === number ? "is-current" : ""}>
                <img src={url} alt={words.picture(number + 1)} />
                {isDone(fit, number) && <Icon name="check" />}
              </li>
            ))}
          </ul>
        ) : (
          pictures.map(({ url }) => <img key={url} class="whole-picture" src={url} alt={words.onlyPicture} />)
        )}
      </div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">{fit.state === "queued" ? words.queued : words.of[fit.kind].running}</h1>
            <progress class="bar" max={1} value={fit.progress} aria-label={words.of[fit.kind].progress}>
              {percent(fit.progress)}
            </progress>
            {isOfSeveral && fit.stage && (
              <p class="fine" role="status">
                {fit.view === null ? words.together : words.alone(fit.view + 1)}
              </p>
            )}
            {isCutOff.value && (
              <p class="note" role="status">
                {words.cutOff}
              </p>
            )}
            <AssumptionNotes assumptions={assumed.value[fit.id] ?? []} asked={asked?.views[0]?.points ?? null} />
            <ol class="stages">
              {STAGES.map((stage, i) => (
                <li key={stage} class={i < at ? "is-done" : i === at ? "is-current" : ""} aria-current={i === at ? "step" : undefined}>
                  <b>{words.stages[stage].label}</b>
                  <span>{words.stages[stage].help}</span>
                </li>
              ))}
            </ol>
          </section>
          <section class="section">
            <h2>{words.misfit.title}</h2>
            <p class="fine">{words.misfit.help}</p>
            <EnergyChart readings={list} />
          </section>
        </div>
        <div class="submit">
          <button
            class="button is-wide"
            type="button"
            disabled={stopping}
            onClick={() => {
              setStopping(true);
              void cancel().then(setStopping);
            }}
          >
            {stopping ? words.stopping : words.cancel}
          </button>
        </div>
      </div>
    </main>
  );
}

/** Pictures are searched one after the other, before all together. */
function isDone({ view, stage, progress }: Fit, number: number): boolean {
  return view === null ? stage !== null && progress > 0.5 : number < view;
}
