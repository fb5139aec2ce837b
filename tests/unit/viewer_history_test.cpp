#include "engine/viewer/history.h"

#include <gtest/gtest.h>

namespace edgesplat::viewer {
namespace {

TEST(History, UndoesAndRedoes) {
    History<int> history(1);
    history.change(2, true);
    history.change(3, true);
    EXPECT_EQ(history.now(), 3);
    history.undo();
    EXPECT_EQ(history.now(), 2);
    history.undo();
    EXPECT_EQ(history.now(), 1);
    EXPECT_FALSE(history.can_undo());
    history.undo();
    EXPECT_EQ(history.now(), 1);
    history.redo();
    history.redo();
    EXPECT_EQ(history.now(), 3);
    EXPECT_FALSE(history.can_redo());
}

TEST(History, DragIsOneStep) {
    History<int> history(1);
    for (int i = 2; i < 50; ++i)
        history.change(i, false);
    EXPECT_EQ(history.now(), 49);
    history.change(50, true);
    history.undo();
    EXPECT_EQ(history.now(), 1);
    history.redo();
    EXPECT_EQ(history.now(), 50);
}

TEST(History, UndoCancelsDrag) {
    History<int> history(1);
    history.change(2, true);
    history.change(7, false);
    history.undo();
    EXPECT_EQ(history.now(), 2);
}

TEST(History, NewChangeClearsRedo) {
    History<int> history(1);
    history.change(2, true);
    history.undo();
    history.change(3, true);
    EXPECT_FALSE(history.can_redo());
    history.undo();
    EXPECT_EQ(history.now(), 1);
}

TEST(History, EqualStateAddsNoStep) {
    History<int> history(1);
    history.change(1, true);
    EXPECT_FALSE(history.can_undo());
}

TEST(History, DropsOldestStepsFirst) {
    History<int> history(0);
    for (int i = 1; i <= 1000; ++i)
        history.change(i, true);
    int steps = 0;
    for (; history.can_undo(); ++steps)
        history.undo();
    EXPECT_GE(steps, 100);
    EXPECT_EQ(history.now(), 1000 - steps);
}

}  // namespace
}  // namespace edgesplat::viewer
