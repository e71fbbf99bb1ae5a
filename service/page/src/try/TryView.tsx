// For developers: a request as programs send it, what the service answers, and the body.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { getResult, postFit } from "../api/calls";
import { problemFrom } from "../api/client";
import { apiKey } from "../api/key";
import type { Fit } from "../api/types";
import { messages } from "../messages";
import { useSkin } from "../products/skin";
import { Choice } from "../ui/Choice";
import { FileButton } from "../ui/FileButton";
import { announce } from "../ui/announce";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import { SNIPPETS, type Language } from "./snippets";

const SAMPLE = "sample.jpg";
const SAMPLE_REQUEST = indented({ gender: "male", height_m: 1.804, views: [{ view: "front" }] });
/** Of somebody else nothing is known yet. */
const UNKNOWN_REQUEST = indented({ gender: null, height_m: null, views: [{ view: "front" }] });

export function TryView() {
  const { trying } = messages;
  /** Null is the service's own sample. */
  const file = useSignal<File | null>(null);
  const request = useSignal(SAMPLE_REQUEST);
  const answer = useSignal<object | null>(null);
  /** Whose body is shown. */
  const fitted = useSignal<Fit | null>(null);
  const sending = useSignal<AbortController | null>(null);
  const language = useSignal<Language>("curl");
  useEffect(() => () => sending.value?.abort(), []);

  /** What is shown together belongs together: another request has no answer yet. */
  const ask = (text: string, picture = file.value) => {
    sending.value?.abort();
    sending.value = answer.value = null;
    fitted.value = null;
    request.value = text;
    file.value = picture;
  };
  const send = async () => {
    ask(request.value);
    const { signal } = (sending.value = new AbortController());
    let told: object | null = null;
    try {
      const picture = file.value ?? (await (await fetch(`/page/${SAMPLE}`)).blob());
      const fit = await postFit(picture, compact(request.value), signal);
      told = fit.state === "succeeded" ? await getResult(fit.id) : fit;
      if (!signal.aborted && fit.state === "succeeded") fitted.value = fit;
    } catch (error) {
      told = problemFrom(error);
    }
    if (signal.aborted) return;
    answer.value = told;
    sending.value = null;
    announce(trying.answered);
  };
  const choose = (chosen: File | undefined) => chosen && ask(UNKNOWN_REQUEST, chosen);
  const asked = {
    origin: location.origin,
    name: file.value?.name ?? SAMPLE,
    isSample: file.value === null,
    request: compact(request.value),
    hasKey: apiKey.value !== null,
  };
  return (
    <main
      class="try"
      onDragOver={(event) => event.preventDefault()}
      onDrop={(event) => {
        event.preventDefault();
        choose(event.dataTransfer?.files[0]);
      }}
    >
      <section>
        <h1>{trying.title}</h1>
        <p class="row">
          <button class="button is-primary" type="button" onClick={() => (ask(SAMPLE_REQUEST, null), void send())}>
            {trying.sample}
          </button>
          <FileButton look="button" onChoose={([chosen]) => choose(chosen)}>
            {trying.choose}
          </FileButton>
        </p>
        <Code label={trying.request(asked.name)} text={request.value} rows={11} onEdit={ask} />
        <button class="button" type="button" disabled={sending.value !== null} onClick={() => void send()}>
          {sending.value ? messages.frame.sending : trying.send}
        </button>
        <Choice
          name="language"
          legend={trying.as}
          quiet
          options={(Object.keys(SNIPPETS) as Language[]).map((value) => ({ value, label: trying.languages[value] }))}
          value={language.value}
          onChange={(chosen) => (language.value = chosen)}
        />
        <Code label={trying.languages[language.value]} text={SNIPPETS[language.value](asked)} rows={16} />
      </section>
      <section aria-busy={sending.value !== null}>
        <Code label={trying.response} text={answer.value ? indented(answer.value) : ""} rows={36} />
      </section>
      <section>
        <h2>{trying.body}</h2>
        {fitted.value && <Upright key={fitted.value.id} fit={fitted.value} />}
        <a href="/docs">{trying.reference}</a>
      </section>
    </main>
  );
}

/** In its colours once they are there. */
function Upright({ fit }: { fit: Fit }) {
  const skin = useSkin(fit.id, true);
  if (skin.state === "coming") return <p class="fine">{messages.look.skinComes}</p>;
  return <DerivedCanvas path={fit.links.files["body_canonical.glb"]!} skin={skin.path} label={messages.trying.body} />;
}

function Code({ label, text, rows, onEdit }: { label: string; text: string; rows: number; onEdit?: (text: string) => void }) {
  const { copy, copied } = messages.trying;
  return (
    <div class="try-code">
      <h2>{label}</h2>
      <button class="link" type="button" onClick={() => void navigator.clipboard.writeText(text).then(() => announce(copied))}>
        {copy(label)}
      </button>
      <textarea aria-label={label} rows={rows} wrap="off" spellcheck={false} readOnly={!onEdit} value={text} onInput={(event) => onEdit?.(event.currentTarget.value)} />
    </div>
  );
}

function indented(value: object): string {
  return JSON.stringify(value, null, 2);
}

/** As it is sent: what is no JSON is left for the service to tell. */
function compact(text: string): string {
  try {
    return JSON.stringify(JSON.parse(text));
  } catch {
    return text;
  }
}
