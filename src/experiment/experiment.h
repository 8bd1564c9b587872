#pragma once
#include <optional>
#include <string>
#include <vector>

#include "render/scene_choice.h"

namespace turbid {

/// What all methods of an experiment have in common, so that their errors can be compared.
enum class EqualBy {
  kTime,     ///< each method renders for so many seconds
  kSamples,  ///< each takes so many samples per pixel
  kError,    ///< each renders until its error is so small; the time that it takes is the result
};

struct ComparisonRule {
  EqualBy equal = EqualBy::kTime;
  /// Processor time of all threads for one render of one method; the end of every run, whatever the rule.
  double seconds = 0;
  uint64_t samples = 0;  ///< per pixel, for kSamples
  double error = 0;      ///< RMSE over the mean of the reference, for kError
};

struct ReferenceSettings {
  std::string integrator;  ///< "TYPE[,key=value]..."
  double seconds = 0;      ///< processor time of all threads, both halves together
};

struct ExperimentScene {
  std::string name;
  std::string file;                      ///< a path from where the program runs
  std::vector<std::string> definitions;  ///< "name=value"
  std::string size;                      ///< "WxH"
  float exposure = 0;                    ///< of the pictures in the report, in stops
  ReferenceSettings reference;
};

struct ExperimentMethod {
  std::string name;
  std::string integrator;  ///< "TYPE[,key=value]..."
};

/// Two methods whose pictures are held against each other, too: made with the same random numbers and as many samples,
/// most of their noise is the same and falls out.
struct MethodPair {
  std::string method, against;
};

/// A number of a publication: `measure` of `method`, divided by that of `over` where there is one (for PSNR: less it).
struct PublishedNumber {
  std::string scene, method, over, measure;
  double value = 0;
  std::string from;  ///< "S2 Fig. 5"
};

/// A figure that a program of experiments/ prints as tables.
struct ProgramSettings {
  std::string name;
  std::vector<std::string> arguments;
  double seconds = 0;                ///< processor time that it is expected to take
  std::vector<std::string> shorter;  ///< arguments in the place of the others when the time scale is below 1; or none
  double shorter_seconds = 0;
};

/// A figure or table of a publication, made again: several methods render the same scenes under one rule, each with
/// several seeds, and are held against references.
struct Experiment {
  std::string name;  ///< of its file, without extension
  std::string file;
  std::string title, figure, about;
  ComparisonRule rule;
  int seeds = 0;
  int points = 0;  ///< of the curve of error, each at twice the time (or samples) of the one before
  std::vector<ExperimentScene> scenes;
  std::vector<ExperimentMethod> methods;
  std::string baseline;           ///< the method that the others' times are put in relation to; or none
  std::vector<MethodPair> pairs;  ///< only at equal samples
  std::vector<PublishedNumber> published;
  std::optional<ProgramSettings> program;  ///< then there are no scenes and methods

  /// Processor seconds that it is to take.
  double declared_seconds(double time_scale) const;
};

/// The scene that a method renders. `size` overrides that of the scene unless empty.
SceneChoice choice_of(const ExperimentScene& scene, const std::string& integrator, const std::string& size);

/// A name as part of a file's name: "S5, q = 0.3" becomes "s5-q-0.3".
std::string file_name(const std::string& name);

}  // namespace turbid
