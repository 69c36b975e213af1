#pragma once

#include "tests/hard/case.h"
#include "tests/hard/dense_overlap.h"

/// Numbers of a run, each by means that share nothing with the solver but the shapes' closed forms.
namespace passung::hard {

inline constexpr double kUm = 1e6;

/// The held part of a scene of shapes.
const scene::PartSpec& heldPart(const scene::SceneSpec& spec);
/// The first other one: its frame is that of the paths.
const scene::PartSpec& fixedPart(const scene::SceneSpec& spec);

/// Between the held part and the others, as shapes (Run::solids); spacing of the samples on faces [m].
DenseDistance denseDistance(const Run& run, double spacing = 1e-3);

/// Deepest overlap of the proxy with the obstacles, at all ticks and between them, where the methods do not look [m].
double deepestOverlap(const Run& run, double spacing = 1e-3);

/// The same at the ticks alone: closed forms go from one to the next by poses of their own.
double deepestShown(const Run& run);

/// Poses (at ticks and between them) at which FCL finds the thin obstacle in the held part shrunk by the field's
/// tolerance on every side.
double crossings(const Run& run);

/// Tip of the held peg below the obstacle's mouth at its deepest [m].
double insertedDepth(const Run& run);

/// RMS of the part above `hz` of a signal of 1 kHz, by a Hann window and Parseval.
double rmsAbove(const std::vector<double>& signal, double hz);

/// Judgements by these: overlap in µm.
Judgement overlapUm(const Run& run);
Judgement crossingCount(const Run& run);
Judgement insertedUm(const Run& run);  // overlap, and at least 19/20 of the bore's depth reached

/// The deepest overlap per that of the penalty at the same stiffness on the same device path.
Judgement overlapPerPenalty(const Run& run);

}  // namespace passung::hard
