// The wire types, by short names; schema.d.ts is made from the service's own openapi.json.
import type { components } from "./schema";

type Schemas = components["schemas"];

export type Job = Schemas["Job"];
export type JobState = Schemas["JobState"];
export type Problem = Schemas["Problem"];
export type FitResult = Schemas["FitResult"];
export type Stage = Schemas["Stage"];
export type Measurement = Schemas["Measurement"];
export type StageMeasurement = Schemas["StageMeasurement"];
export type UploadedImage = Schemas["UploadedImage"];
export type InitialPose = Schemas["InitialPose"];
export type InitialPoseRequest = Schemas["InitialPoseRequest"];
export type PointsProposal = Schemas["PointsProposal"];
export type PointsOfImage = Schemas["PointsOfImage"];
export type FitOfImage = Schemas["FitOfImage"];
export type KnownMeasurements = NonNullable<Schemas["FitOptions"]["measurements"]>;
export type FitOptions = Schemas["FitOptions"];
export type Gender = Schemas["Gender"];
export type Cues = Schemas["Cues"];
export type LightGuess = Schemas["LightGuess"];
export type Surroundings = NonNullable<LightGuess["surroundings"]>;
/** Requests that are read back leave `auto` out. */
export type Clothing = Schemas["Clothing"];
export type Limb = Schemas["Limb"];
export type Facing = Schemas["Facing"];
export type EventData = Schemas["EventData"];
export type CameraResult = Schemas["CameraResult"];
/** Of a fit, or of a scan. */
export type Derivation = Schemas["Derivation"] | Schemas["ScanDerivation"];
export type DerivationPage = Schemas["DerivationPage"] | Schemas["ScanDerivationPage"];
export type DerivationKind = Schemas["DerivationKind"];
export type DerivationRequest = Schemas["DerivationRequest"];
export type NamedMotion = Schemas["NamedMotion"];
export type NamedPose = Schemas["NamedPose"];
export type TextureColours = Schemas["TextureColours"];
export type TextureSize = NonNullable<Schemas["TextureOptions"]["size"]>;
export type DerivationResult = Schemas["DerivationResult"];
export type Scan = Schemas["Scan"];
export type ScanOfImages = Schemas["ScanOfImages"];
export type ScanOptions = Schemas["ScanOptions"];
export type ScanResult = Schemas["ScanResult"];
export type ViewKind = Schemas["ViewKind"];
export type CheckOfImage = Schemas["CheckOfImage"];
export type CaptureCheck = Schemas["CaptureCheck"];
export type Finding = Schemas["Finding"];
export type PointName = NonNullable<Finding["points"]>[number];
export type CombinedResult = Schemas["CombinedResult"];
export type SizeResult = Schemas["SizeResult"];
