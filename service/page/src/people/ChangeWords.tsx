// Which differences are more than chance, in words.
import { useState } from "preact/hooks";
import type { ChangeResult } from "../api/types";
import { person } from "../draft/draft";
import { day, decimal, moment } from "../messages/figures";
import { messages } from "../messages/language";
import { inUnit, measureLabel } from "../result/reading";
import { answered } from "../ui/answered";
import { ProblemNote } from "../ui/ProblemNote";
import { Served } from "../ui/Served";
import { useChange } from "./changes";
import type { PersonRecord } from "./records";

type Change = ChangeResult["changes"][number];

/** `group` is newest first and of two or more: the newest is compared with an earlier one. */
export function ChangeWords({ group }: { group: readonly PersonRecord[] }) {
  const { people: words } = messages.value;
  const [newest, ...earlier] = group as [PersonRecord, ...PersonRecord[]];
  const [sinceId, setSince] = useState<string | null>(null);
  const since = earlier.find(({ fit }) => fit.id === sinceId) ?? earlier.at(-1)!;
  const { result, problem } = useChange(newest, since);
  return (
    <section class="person-change" aria-labelledby="change-title" aria-busy={!result && !problem}>
      <h2 id="change-title">{words.changed}</h2>
      <div class="field">
        <label for="change-since">{words.since(words.kinds[newest.fit.kind], moment(newest.fit.created_at))}</label>
        <select id="change-since" value={since.fit.id} onChange={(event) => setSince(event.currentTarget.value)}>
          {earlier.map(({ fit }) => (
            <option key={fit.id} value={fit.id}>
              {moment(fit.created_at)}
            </option>
          ))}
        </select>
      </div>
      {problem && <ProblemNote problem={problem} />}
      {result && <Told result={result} since={day(since.fit.created_at)} />}
    </section>
  );
}

function Told({ result, since }: { result: ChangeResult; since: string }) {
  const { people: words } = messages.value;
  const beyond = result.changes.filter((each) => each.is_change);
  const within = result.changes.filter((each) => !each.is_change);
  return (
    <>
      {result.warnings.map(({ code, message }) => (
        <p class="note" key={code}>
          {answered("warnings", code) ?? <Served text={message} />}
        </p>
      ))}
      <p>
        <strong>{beyond.length === 0 ? words.nothingBeyond(since) : words.beyond(beyond.length)}</strong>
      </p>
      <ul class="change-list">
        {beyond.map((each) => (
          <li key={each.name}>{inWords(each)}</li>
        ))}
      </ul>
      {within.length > 0 && (
        <>
          <p>{words.within}</p>
          <ul class="change-list is-within">
            {within.map((each) => (
              <li key={each.name}>{inWords(each)}</li>
            ))}
          </ul>
        </>
      )}
      <p class="fine">{words.howCompared(result.changes.length)}</p>
    </>
  );
}

function inWords({ name, unit: known, difference, least, is_change, p_value }: Change): string {
  const { people: words } = messages.value;
  const { factor, unit } = inUnit(known, person.value.units);
  const by = `${decimal(Math.abs(factor * difference), 1)} ${unit}`;
  const label = measureLabel(name);
  if (p_value === null && !is_change) return words.same(label);
  const told = difference < 0 ? words.less(label, by) : words.more(label, by);
  return is_change ? told : words.chance(told, `${decimal(factor * least, 1)} ${unit}`);
}
