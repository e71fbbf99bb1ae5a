// A number to be slid to, with what it means.
interface Props {
  readonly label: string;
  /** What a screen reader says, where that is more than is written. */
  readonly named?: string;
  readonly range: { readonly least: number; readonly most: number; readonly step: number };
  readonly value: number;
  readonly text: string;
  readonly onInput: (value: number) => void;
}

export function Slider({ label, named, range, value, text, onInput }: Props) {
  return (
    <label class="slider">
      <span>{label}</span>
      <input
        type="range"
        min={range.least}
        max={range.most}
        step={range.step}
        value={value}
        aria-label={named}
        aria-valuetext={text}
        onInput={(event) => onInput(Number(event.currentTarget.value))}
      />
      <output>{text}</output>
    </label>
  );
}
