// All of a person: how their measurements went with time, and their fits.
import type { FitKind } from "../api/fits";
import { person } from "../draft/draft";
import { inUnits } from "../draft/person";
import { entries } from "../history/store";
import { decimal, moment } from "../messages/figures";
import { messages } from "../messages/language";
import { fitAddress } from "../route";
import { measureLabel } from "../result/reading";
import { Choice } from "../ui/Choice";
import { ProblemNote } from "../ui/ProblemNote";
import { ChangeWords } from "./ChangeWords";
import { COMPARED, charted } from "./chosen";
import { comparable } from "./changes";
import { EraseAll } from "./EraseAll";
import { MOST_COMPARED, useRecords } from "./records";
import type { PersonRecord } from "./records";
import { TimeChart } from "./TimeChart";

export function PersonView({ label }: { label: string }) {
  const { people: words } = messages.value;
  const { records, problem } = useRecords(label);
  const group = comparable(records ?? []);
  return (
    <main class="person-page" aria-busy={!records && !problem}>
      <h1>{label}</h1>
      {problem && <ProblemNote problem={problem} />}
      {records && <p class="lead">{records.length === 0 ? words.none : words.has(countOf(records, "fit"), countOf(records, "scan"))}</p>}
      {records?.some(({ measurements }) => measurements.length > 0) && <OverTime records={records} />}
      {group.length > 1 && <ChangeWords group={group} />}
      {records && records.length > 0 && (
        <>
          <Records records={records} />
          <EraseAll label={label} fits={countOf(records, "fit")} scans={countOf(records, "scan")} />
        </>
      )}
    </main>
  );
}

function countOf(records: readonly PersonRecord[], kind: FitKind): number {
  return records.filter(({ fit }) => fit.kind === kind).length;
}

function OverTime({ records }: { records: readonly PersonRecord[] }) {
  const { frame, people: words, person: said, result } = messages.value;
  const { units } = person.value;
  return (
    <section aria-labelledby="over-time-title">
      <header class="section-head">
        <h2 id="over-time-title">{words.overTime}</h2>
        <Choice
          name="person-units"
          legend={frame.units}
          quiet
          options={[
            { value: "metric", label: said.metric },
            { value: "imperial", label: result.imperial },
          ]}
          value={units}
          onChange={(value) => (person.value = inUnits(person.value, value))}
        />
      </header>
      <p class="fine">{words.bars}</p>
      {records.length > MOST_COMPARED && <p class="fine">{words.newestOnly(decimal(MOST_COMPARED))}</p>}
      <fieldset class="charted">
        <legend class="unseen">{words.charted}</legend>
        {COMPARED.map((name) => {
          const isShown = charted.value.includes(name);
          return (
            <label key={name} class="check">
              <input
                type="checkbox"
                checked={isShown}
                onChange={() => (charted.value = COMPARED.filter((each) => (each === name ? !isShown : charted.value.includes(each))))}
              />
              {measureLabel(name)}
            </label>
          );
        })}
      </fieldset>
      <div class="time-charts">
        {charted.value.map((name) => (
          <TimeChart key={name} name={name} records={records} />
        ))}
      </div>
    </section>
  );
}

function Records({ records }: { records: readonly PersonRecord[] }) {
  const { frame, people: words } = messages.value;
  return (
    <section aria-labelledby="records-title">
      <h2 id="records-title">{words.records}</h2>
      <ul class="history">
        {records.map(({ fit }) => {
          const thumbnail = entries.value.find(({ id }) => id === fit.id)?.thumbnail;
          return (
            <li key={fit.id}>
              <a href={fitAddress(fit)}>
                {thumbnail && <img src={thumbnail} alt="" width="48" height="64" />}
                <span>
                  <b>{moment(fit.created_at)}</b>
                  <small>{words.kinds[fit.kind]}</small>
                  <small>{frame.list.states[fit.state]}</small>
                </span>
              </a>
            </li>
          );
        })}
      </ul>
    </section>
  );
}
