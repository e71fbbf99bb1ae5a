// How good measurements are, in figures: what the first screen's sentence is taken from.
import { decimal, measured } from "../messages/figures";
import { messages } from "../messages";
import { START_ADDRESS } from "../route";
import { LOOSE_WAIST, PAIR, PEOPLE, SINGLE } from "./figures";
import type { Errors } from "./figures";

export function AccuracyView() {
  const { accuracy } = messages;
  return (
    <main class="accuracy">
      <h1>{accuracy.title}</h1>
      <p class="lead">{accuracy.lead(decimal(PEOPLE))}</p>
      <ErrorTable words={accuracy.pair} rows={PAIR} />
      <ErrorTable words={accuracy.single} rows={SINGLE} />
      <p>{accuracy.loose(measured(LOOSE_WAIST, "centimeter"))}</p>
      <p class="fine">{accuracy.limits}</p>
      <p class="row">
        <a class="button" href={START_ADDRESS}>
          {accuracy.back}
        </a>
      </p>
    </main>
  );
}

interface TableProps<Row extends string> {
  readonly words: { readonly caption: string; readonly waist: string; readonly rows: Readonly<Record<Row, string>> };
  readonly rows: Readonly<Record<Row, Errors>>;
}

function ErrorTable<Row extends string>({ words, rows }: TableProps<Row>) {
  const { columns, given } = messages.accuracy;
  return (
    <div class="accuracy-scroll">
      <table class="accuracy-table">
        <caption>{words.caption}</caption>
        <thead>
          <tr>
            <td />
            <th scope="col">{columns.chest}</th>
            <th scope="col">{words.waist}</th>
            <th scope="col">{columns.hip}</th>
            <th scope="col">{columns.weight}</th>
          </tr>
        </thead>
        <tbody>
          {(Object.keys(words.rows) as Row[]).map((name) => {
            const { chest, waist, hip, weight } = rows[name];
            return (
              <tr key={name}>
                <th scope="row">{words.rows[name]}</th>
                {[chest, waist, hip].map((error, column) => (
                  <td key={column}>{measured(error, "centimeter", 1)}</td>
                ))}
                <td>{weight === null ? given : measured(weight, "kilogram", 1)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
