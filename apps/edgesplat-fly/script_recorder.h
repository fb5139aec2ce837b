// Records user input as a script.
#pragma once

#include <string>

#include "apps/edgesplat-fly/input.h"

class ScriptRecorder {
  public:
    explicit ScriptRecorder(double step) : step_(step) {}
    void add(const Input& input);
    std::string text() const;

  private:
    double step_, time_ = 0;
    long written_ = 0;  ///< frames that the text covers
    Input last_;
    bool first_ = true;
    std::string text_;
};
