//! Data derived from a scene, computed once for any number of pictures.

use std::any::Any;
use std::sync::{Arc, Mutex};

/// A cache indexed by the type and value of a key. A technique stores here what it derives from a scene, so that
/// planning another picture of an unchanged scene only needs a lookup.
#[derive(Default)]
pub struct Derived {
    kept: Mutex<Vec<Entry>>,
}

/// A key and its value.
type Entry = (Box<dyn Any + Send + Sync>, Arc<dyn Any + Send + Sync>);

/// The maximum number of values kept per key type. A key that changes from picture to picture, such as an angle under
/// interactive control, must not fill the memory.
const MOST: usize = 4;

impl Derived {
    /// Returns the value of a key, computing it if it is missing. A key type must always be used with the same value
    /// type.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get<K, T, E>(&self, key: K, make: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E>
    where
        K: PartialEq + Send + Sync + 'static,
        T: Send + Sync + 'static,
    {
        if let Some(found) = self.find(&key) {
            return Ok(found);
        }
        // Computed without holding the lock, because `make` may read other values from this cache.
        let made = Arc::new(make()?);
        // Another thread may have stored the value in the meantime.
        if let Some(found) = self.find(&key) {
            return Ok(found);
        }
        let mut kept = self.kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let same_type = |entry: &Entry| entry.0.is::<K>();
        if kept.iter().filter(|entry| same_type(entry)).count() >= MOST
            && let Some(oldest) = kept.iter().position(same_type)
        {
            kept.remove(oldest);
        }
        kept.push((Box::new(key), Arc::clone(&made) as Arc<dyn Any + Send + Sync>));
        Ok(made)
    }

    fn find<K: PartialEq + 'static, T: Send + Sync + 'static>(&self, key: &K) -> Option<Arc<T>> {
        let kept = self.kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let same = |known: &Box<dyn Any + Send + Sync>| known.downcast_ref::<K>().is_some_and(|known| known == key);
        let (_, value) = kept.iter().find(|(known, _)| same(known))?;
        Arc::clone(value).downcast().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[derive(PartialEq)]
    struct Angle(u32);

    #[test]
    fn a_value_is_made_once_for_each_key() {
        let derived = Derived::default();
        let get = |angle, value: u32| derived.get(Angle(angle), || Ok::<_, Infallible>(value)).expect("it cannot fail");
        assert_eq!([*get(1, 10), *get(2, 20), *get(1, 30)], [10, 20, 10]);
        assert!(Arc::ptr_eq(&get(1, 0), &get(1, 0)));
    }

    #[test]
    fn what_failed_is_made_again() {
        let derived = Derived::default();
        assert_eq!(derived.get(Angle(1), || Err::<u32, _>("no")), Err("no"));
        assert_eq!(derived.get(Angle(1), || Ok::<_, &str>(5)).map(|value| *value), Ok(5));
    }

    #[test]
    fn of_keys_that_change_the_oldest_goes() {
        let derived = Derived::default();
        for angle in 0..100 {
            let _ = derived.get(Angle(angle), || Ok::<_, Infallible>(angle));
        }
        assert_eq!(derived.kept.lock().expect("no thread panicked").len(), MOST);
        let again = derived.get(Angle(0), || Ok::<_, Infallible>(7)).expect("it cannot fail");
        assert_eq!(*again, 7, "the first was forgotten");
    }
}
