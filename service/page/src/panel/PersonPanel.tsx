// Who is in the picture: gender, height, weight, clothes, what a tape said.
import { clothing, person, views } from "../draft/draft";
import { liveBody } from "../draft/live";
import { TAPE_NAMES, TAPE_RANGE_CM, heightFault, heightInWords, heightM, inUnits, inches, tapeFault, weightFault } from "../draft/person";
import { proposal } from "../draft/proposing";
import { decimal, measured } from "../messages/figures";
import { messages } from "../messages";
import { measureLabel } from "../result/reading";
import { Choice } from "../ui/Choice";

export function PersonPanel() {
  const { frame, person: said } = messages;
  const known = person.value;
  const metric = known.units === "metric";
  const faults = { height: heightFault(known), weight: weightFault(known) };
  return (
    <section class="section" aria-labelledby="person-title">
      <header class="section-head">
        <h2 id="person-title">{said.title}</h2>
        <Choice
          name="units"
          legend={frame.units}
          quiet
          options={[
            { value: "metric", label: said.metric },
            { value: "imperial", label: said.imperial },
          ]}
          value={known.units}
          onChange={(units) => (person.value = inUnits(known, units))}
        />
      </header>
      <Choice
        name="gender"
        legend={said.body}
        options={[
          { value: "female", label: said.female },
          { value: "male", label: said.male },
        ]}
        value={known.gender}
        onChange={(gender) => (person.value = { ...known, gender })}
      />
      <div class="fields">
        <div class="field">
          <label for="height">{said.height}</label>
          <span class="inputs">
            <span class="unit-input">
              <input
                id="height"
                inputMode="decimal"
                autocomplete="off"
                placeholder={frame.unknown}
                value={known.height}
                aria-invalid={faults.height !== null}
                aria-describedby="height-note"
                onInput={(event) => (person.value = { ...known, height: event.currentTarget.value })}
              />
              <i>{metric ? said.symbols.cm : said.symbols.ft}</i>
            </span>
            {!metric && (
              <span class="unit-input">
                <input
                  aria-label={said.inches}
                  inputMode="decimal"
                  autocomplete="off"
                  value={known.inches}
                  aria-invalid={faults.height !== null}
                  onInput={(event) => (person.value = { ...known, inches: event.currentTarget.value })}
                />
                <i>{said.symbols.in}</i>
              </span>
            )}
          </span>
        </div>
        <div class="field">
          <label for="weight">{said.weight}</label>
          <span class="unit-input">
            <input
              id="weight"
              inputMode="decimal"
              autocomplete="off"
              placeholder={frame.unknown}
              value={known.weight}
              aria-invalid={faults.weight !== null}
              aria-describedby="weight-note"
              onInput={(event) => (person.value = { ...known, weight: event.currentTarget.value })}
            />
            <i>{metric ? said.symbols.kg : said.symbols.lb}</i>
          </span>
        </div>
      </div>
      <p id="height-note" class={`fine ${faults.height ? "is-fault" : ""}`}>
        {faults.height ?? (heightM(known) === null ? assumedHeight() : said.heightHeld)}
      </p>
      <p id="weight-note" class={`fine ${faults.weight ? "is-fault" : ""}`}>
        {faults.weight ?? said.weightHelps}
      </p>
      <Clothes />
      <Tape />
    </section>
  );
}

function assumedHeight(): string {
  const body = liveBody.value;
  const { person: said } = messages;
  return body ? said.assumedHeight(heightInWords(body.height_m, person.value.units)) : said.meanHeight;
}

/** As they are seen until somebody says otherwise: what is seen is judged by region, and more finely than a word. */
function Clothes() {
  const { clothes } = messages.panel;
  return (
    <Choice
      name="clothing"
      legend={clothes.title}
      options={[
        { value: "tight", ...clothes.tight },
        { value: "loose", ...clothes.loose },
        { value: "outer", ...clothes.outer },
      ]}
      value={clothing.value === "auto" ? (proposal.value?.clothing?.kind ?? null) : clothing.value}
      onChange={(value) => {
        for (const view of views.value) view.clothing.value = value;
      }}
    />
  );
}

/** What was measured with a tape. */
function Tape() {
  const { frame, person: said } = messages;
  const known = person.value;
  const fault = tapeFault(known);
  const metric = known.units === "metric";
  const unit = said.symbols[metric ? "cm" : "in"];
  const unitName = metric ? "centimeter" : "inch";
  const [low, high] = TAPE_RANGE_CM.map((cm) => (metric ? cm : inches(cm))) as [number, number];
  const count = TAPE_NAMES.filter((name) => known.tape[name]?.trim()).length;
  return (
    <details class="fold">
      <summary>
        {said.known} {count > 0 && <span class="count">{said.given(count)}</span>}
      </summary>
      <div class="fields">
        {TAPE_NAMES.map((name) => (
          <div class="field" key={name}>
            <label for={`tape-${name}`}>{measureLabel(name)}</label>
            <span class="unit-input">
              <input
                id={`tape-${name}`}
                inputMode="decimal"
                autocomplete="off"
                placeholder={frame.unknown}
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
        {fault ? said.faults.tape(measureLabel(fault), decimal(low), measured(high, unitName)) : said.tapeTrust}
      </p>
    </details>
  );
}
