// Who is in the picture: gender, height, weight.
import { person } from "../draft/draft";
import { liveBody } from "../draft/live";
import { TAPE_NAMES, heightFault, heightM, inUnits, tapeFault, weightFault } from "../draft/person";
import { measureLabel } from "../result/reading";
import { Choice } from "../ui/Choice";

interface Words {
  /** What follows where no height is given. */
  readonly noHeight: string;
  readonly weight: string;
}

/** Without other `words`, those for one picture. */
export function PersonPanel({ words }: { words?: Words }) {
  const known = person.value;
  const metric = known.units === "metric";
  const faults = { height: heightFault(known), weight: weightFault(known) };
  return (
    <section class="section" aria-labelledby="person-title">
      <header class="section-head">
        <h2 id="person-title">Person</h2>
        <Choice
          name="units"
          legend="Units"
          quiet
          options={[
            { value: "metric", label: "cm, kg" },
            { value: "imperial", label: "ft, lb" },
          ]}
          value={known.units}
          onChange={(units) => (person.value = inUnits(known, units))}
        />
      </header>
      <Choice
        name="gender"
        legend="Body"
        options={[
          { value: "female", label: "Female" },
          { value: "male", label: "Male" },
        ]}
        value={known.gender}
        onChange={(gender) => (person.value = { ...known, gender })}
      />
      <div class="fields">
        <div class="field">
          <label for="height">Height</label>
          <span class="inputs">
            <span class="unit-input">
              <input
                id="height"
                inputMode="decimal"
                autocomplete="off"
                placeholder="unknown"
                value={known.height}
                aria-invalid={faults.height !== null}
                aria-describedby="height-note"
                onInput={(event) => (person.value = { ...known, height: event.currentTarget.value })}
              />
              <i>{metric ? "cm" : "ft"}</i>
            </span>
            {!metric && (
              <span class="unit-input">
                <input
                  aria-label="Height, inches beyond the feet"
                  inputMode="decimal"
                  autocomplete="off"
                  value={known.inches}
                  aria-invalid={faults.height !== null}
                  onInput={(event) => (person.value = { ...known, inches: event.currentTarget.value })}
                />
                <i>in</i>
              </span>
            )}
          </span>
        </div>
        <div class="field">
          <label for="weight">Weight</label>
          <span class="unit-input">
            <input
              id="weight"
              inputMode="decimal"
              autocomplete="off"
              placeholder="unknown"
              value={known.weight}
              aria-invalid={faults.weight !== null}
              aria-describedby="weight-note"
              onInput={(event) => (person.value = { ...known, weight: event.currentTarget.value })}
            />
            <i>{metric ? "kg" : "lb"}</i>
          </span>
        </div>
      </div>
      <p id="height-note" class={`fine ${faults.height ? "is-fault" : ""}`}>
        {faults.height ?? (heightM(known) === null ? (words?.noHeight ?? assumedHeight()) : "Height is held exactly as given.")}
      </p>
      <p id="weight-note" class={`fine ${faults.weight ? "is-fault" : ""}`}>
        {faults.weight ?? words?.weight ?? "If you know it, the weight helps most: one view does not show how deep a body is."}
      </p>
      <Tape />
    </section>
  );
}

function assumedHeight(): string {
  const body = liveBody.value;
  if (!body) return "Without a height the mean of the gender is assumed.";
  return `Without a height ${(body.height_m * 100).toFixed(0)} cm are assumed.`;
}

/** What was measured with a tape. */
function Tape() {
  const known = person.value;
  const fault = tapeFault(known);
  const count = TAPE_NAMES.filter((name) => known.tape[name]?.trim()).length;
  const unit = known.units === "metric" ? "cm" : "in";
  return (
    <details class="fold">
      <summary>Known measurements {count > 0 && <span class="count">{count} given</span>}</summary>
      <div class="fields">
        {TAPE_NAMES.map((name) => (
          <div class="field" key={name}>
            <label for={`tape-${name}`}>{measureLabel(name)}</label>
            <span class="unit-input">
              <input
                id={`tape-${name}`}
                inputMode="decimal"
                autocomplete="off"
                placeholder="unknown"
                value={known.tape[name] ?? ""}
                aria-invalid={fault === name}
                aria-describedby="tape-note"
                onInput={(event) => (person.value = { ...known, tape: { ...known.tape, [name]: event.currentTarget.value } })}
              />
              <i>{unit}</i>
            </span>
          </div>
        ))}
      </div>
      <p id="tape-note" class={`fine ${fault ? "is-fault" : ""}`}>
        {fault
          ? `${measureLabel(fault)}: between ${known.units === "metric" ? "10 and 200 cm" : "4 and 79 in"}, please.`
          : "On bare skin or close to it. A tape is trusted to 1 cm."}
      </p>
    </details>
  );
}
