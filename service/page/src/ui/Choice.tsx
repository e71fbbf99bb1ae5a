// One of a few: radio buttons that look like a switch.

interface Option<T extends string> {
  readonly value: T;
  readonly label: string;
  readonly title?: string;
}

interface Props<T extends string> {
  readonly name: string;
  readonly legend: string;
  readonly options: readonly Option<T>[];
  readonly value: T | null;
  readonly onChange: (value: T) => void;
  readonly quiet?: boolean;
}

export function Choice<T extends string>({ name, legend, options, value, onChange, quiet = false }: Props<T>) {
  return (
    <fieldset class="choice">
      <legend class={quiet ? "unseen" : ""}>{legend}</legend>
      <div class="choice-row">
        {options.map((option) => (
          <label key={option.value} title={option.title}>
            <input
              type="radio"
              name={name}
              value={option.value}
              checked={option.value === value}
              onChange={() => onChange(option.value)}
            />
            <span>{option.label}</span>
          </label>
        ))}
      </div>
    </fieldset>
  );
}
